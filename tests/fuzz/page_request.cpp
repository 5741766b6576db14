// Requests to a served explorer, as lines: nothing but the token opens the WebSocket.
#include <array>
#include <string>

#include "tests/fuzz/memory_file.hpp"
#include "ui/serve/http/answer.hpp"

int fuzz_page_request(const std::uint8_t* bytes, std::size_t size) {
  using namespace sweepscope::ui;
  std::string_view rest = sweepscope::test::text_of(bytes, size);
  std::array<std::string_view, 7> lines;
  for (std::string_view& line : lines) {
    line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  }
  const Request request{lines[0], lines[1], lines[2], lines[3], lines[4], lines[5], lines[6] == "1"};
  const sweepscope::ui::Answer answer = answer_to(request, {false, {"robot.example"}}, "secret");
  const bool named = request.protocols.find("token.secret") != request.protocols.npos;
  if (answer.kind == sweepscope::ui::Answer::Kind::kWebSocket && (!named || request.origin.empty()))
    __builtin_trap();
  if (answer.kind == sweepscope::ui::Answer::Kind::kUpload &&
      (request.method != "PUT" || request.origin.empty()))
    __builtin_trap();
  if (answer.status == 421 || answer.status == 403) return 0;
  if (security_policy(request.host).find_first_of("\r\n\"") != std::string::npos) __builtin_trap();
  return 0;
}
