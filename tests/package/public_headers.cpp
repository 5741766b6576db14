// Every public header compiles where only the package is installed: the list in core/CMakeLists.txt.
#include <sweepscope/core/error.hpp>
#include <sweepscope/core/io/cloud_file.hpp>
#include <sweepscope/core/io/trajectory_file.hpp>
#include <sweepscope/core/job.hpp>
#include <sweepscope/core/map/offset_map.hpp>
#include <sweepscope/core/offset/estimate.hpp>
#include <sweepscope/core/offset/estimator.hpp>
#include <sweepscope/core/recording/formats/read_recording.hpp>
#include <sweepscope/core/recording/recording.hpp>
#include <sweepscope/core/recording/rig.hpp>
#include <sweepscope/core/results/estimate_json.hpp>
#include <sweepscope/core/simulation/simulate.hpp>
