#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sweepscope {

/// The candidate that a misspelt word was probably meant to be, or "" where none is near: at most a third of
/// the word's letters (at least one) are missing, superfluous, wrong or swapped with their neighbour, or the
/// word is the beginning of one candidate alone. The first of equally near ones.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

}  // namespace sweepscope
