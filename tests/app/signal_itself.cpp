// Preloaded into a program under test, it has the program send a signal to itself at a moment that the test
// names, so that no clock decides how far the program is. From the environment:
//   SIGNAL_ITSELF        the signal's number
//   SIGNAL_ITSELF_AT     words: the signal is sent once they were written or a file was renamed to a name
//   with them;
//                        empty: as soon as the program handles the signal
//   SIGNAL_ITSELF_TIMES  how many times that is to happen first
#include <dlfcn.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

int signal_number() {
  static const int number = std::stoi(std::getenv("SIGNAL_ITSELF"));
  return number;
}

const std::string& words() {
  static const std::string words = std::getenv("SIGNAL_ITSELF_AT");
  return words;
}

// To the thread that comes here: it is delivered before anything else is done.
void count_moment() {
  static std::atomic<int> left{std::stoi(std::getenv("SIGNAL_ITSELF_TIMES"))};
  if (--left == 0) raise(signal_number());
}

void look_at(std::string_view text) {
  if (!words().empty() && text.find(words()) != std::string_view::npos) count_moment();
}

template <typename Function>
Function* behind(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* stream) {
  static auto* const real = behind<std::size_t(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  const std::size_t written = real(data, size, count, stream);
  look_at({static_cast<const char*>(data), size * written});
  return written;
}

ssize_t write(int descriptor, const void* data, std::size_t size) {
  static auto* const real = behind<ssize_t(int, const void*, std::size_t)>("write");
  const ssize_t written = real(descriptor, data, size);
  if (written > 0) look_at({static_cast<const char*>(data), static_cast<std::size_t>(written)});
  return written;
}

int rename(const char* from, const char* to) noexcept {
  static auto* const real = behind<int(const char*, const char*)>("rename");
  const int result = real(from, to);
  if (result == 0) look_at(to);
  return result;
}

int sigaction(int number, const struct sigaction* action, struct sigaction* before) noexcept {
  static auto* const real = behind<int(int, const struct sigaction*, struct sigaction*)>("sigaction");
  const int result = real(number, action, before);
  if (words().empty() && number == signal_number() && action != nullptr) count_moment();
  return result;
}

}  // extern "C"
