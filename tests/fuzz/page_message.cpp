// What a page sends to a served explorer: whatever it is, what is taken lies within the protocol.
#include "tests/fuzz/memory_file.hpp"
#include "ui/serve/protocol.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace sweepscope::ui;
  const auto message = parse_page_message(sweepscope::test::text_of(bytes, size));
  sweepscope::test::expect_sentence(message);
  if (!message) return 0;
  if (const auto* input = std::get_if<InputMessage>(&*message)) {
    for (const InputEvent& event : input->events) {
      const bool known = event.button >= 0 && event.button <= 2 && event.modifiers <= 7 && event.key >= 0 &&
                         event.key < 512 && event.what != InputEvent::What::kDrop;
      if (!known || !(event.x >= -16384 && event.x <= 16384)) __builtin_trap();
    }
  }
  if (const auto* wanted = std::get_if<SizeMessage>(&*message)) {
    const auto possible = [](int side) { return side >= kMinServedSide_px && side <= kMaxServedSide_px; };
    if (!possible(wanted->width_px) || !possible(wanted->height_px)) __builtin_trap();
  }
  const auto* upload = std::get_if<UploadMessage>(&*message);
  if (upload != nullptr && (upload->size_bytes > 1'000'000'000'000'000 || upload->name.size() > 1024))
    __builtin_trap();
  return 0;
}
