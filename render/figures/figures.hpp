#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "render/figures/recipe.hpp"
#include "render/pictures/canvas.hpp"

namespace sweepscope {

/// Makes a recipe's figures and tables in a folder, which is created if it is missing: NAME.png and the like,
/// NAME.csv, NAME.md and NAME.tex. Estimates are kept in its folder `cache`. `said` receives the steps, and
/// each file when it is written; finished files are kept on failure or interruption. No file that the recipe
/// reads is overwritten: see check_run_files.
Result<std::vector<std::filesystem::path>> make_figures(const Recipe& recipe,
                                                        const std::filesystem::path& folder, Canvas& canvas,
                                                        const Job& job,
                                                        const std::function<void(const std::string&)>& said);

}  // namespace sweepscope
