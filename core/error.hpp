#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace sweepscope {

/// The program's exit codes.
enum class ExitCode : int {
  kDone = 0,
  kNotAsExpected = 1,  // an offset lies outside of where it was expected
  kWrongUsage = 2,
  kUnreadableInput = 3,
  kNotIdentifiable = 4,
  kImageDiffers = 5,
  kInterrupted = 130,
};

/// An expected failure: the exit code, and one sentence that names the file and the place in it. Programming
/// errors are exceptions instead.
struct Error {
  ExitCode code = ExitCode::kUnreadableInput;  // that the program ends with
  std::string message;                         // for a person
};

/// A value, or the error that prevented it.
template <typename T>
using Result = tl::expected<T, Error>;

/// An error, as a function that returns a Result returns it.
inline tl::unexpected<Error> failure(ExitCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

/// The same for an input that cannot be read.
inline tl::unexpected<Error> unreadable(std::string message) {
  return failure(ExitCode::kUnreadableInput, std::move(message));
}

}  // namespace sweepscope
