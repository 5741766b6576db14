#include "ui/host/input_queue.hpp"

#include <gtest/gtest.h>

namespace sweepscope::ui {
namespace {

/// A key's press, its text and its release, as a window reports them.
void strike(std::vector<InputEvent>& events, char letter) {
  const Key key = letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter;
  events.push_back(InputEvent::stroke(key, true, 0));
  events.push_back(InputEvent::words(std::string(1, letter)));
  events.push_back(InputEvent::stroke(key, false, 0));
}

void strike_key(std::vector<InputEvent>& events, Key key, unsigned modifiers = 0) {
  events.push_back(InputEvent::stroke(key, true, modifiers));
  events.push_back(InputEvent::stroke(key, false, modifiers));
}

std::string text_of(std::span<const InputEvent> events) {
  std::string text;
  for (const InputEvent& event : events) text += event.what == InputEvent::What::kText ? event.text : "";
  return text;
}

/// The events of each frame until nothing waits.
std::vector<std::vector<InputEvent>> frames_of(const std::vector<InputEvent>& events) {
  InputQueue queue;
  queue.add(events);
  std::vector<std::vector<InputEvent>> frames;
  while (!queue.empty()) frames.push_back(queue.take());
  return frames;
}

TEST(Frames, APressAndItsReleaseNeedAFrameEach) {
  const std::vector<InputEvent> click{InputEvent::move(1, 1), InputEvent::press(0, true),
                                      InputEvent::press(0, false)};
  EXPECT_EQ(events_of_next_frame(click), 2u);
  const std::vector<InputEvent> word{InputEvent::words("a"), InputEvent::words("b")};
  EXPECT_EQ(events_of_next_frame(word), 2u);
  for (const Key key : {keys::kBackspace, keys::kLeft, keys::kEnter}) {
    const std::vector<InputEvent> events{InputEvent::stroke(key, true, 0), InputEvent::stroke('B', false, 0),
                                         InputEvent::stroke(key, false, 0)};
    EXPECT_EQ(events_of_next_frame(events), 2u);
  }
  std::vector<InputEvent> chord;
  strike_key(chord, 'A', kCtrl);
  EXPECT_EQ(events_of_next_frame(chord), 1u);
}

TEST(Frames, AMoveAndTheReleaseAfterItNeedAFrameEach) {
  const std::vector<InputEvent> lifted{InputEvent::move(2, 1), InputEvent::press(0, false)};
  EXPECT_EQ(events_of_next_frame(lifted), 1u);
  const std::vector<InputEvent> put{InputEvent::move(2, 1), InputEvent::press(0, true)};
  EXPECT_EQ(events_of_next_frame(put), 2u);
}

TEST(InputQueue, ALineTypedFastIsOneFramesText) {
  std::vector<InputEvent> events;
  const std::string line = "export-picture /tmp/pictures/metro.png";
  for (const char letter : line) strike(events, letter);
  const auto frames = frames_of(events);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(text_of(frames[0]), line);
}

TEST(InputQueue, TextAfterAKeyThatEditsComesInALaterFrame) {
  std::vector<InputEvent> events;
  strike(events, 'a');
  strike_key(events, keys::kBackspace);
  strike(events, 'b');
  const auto frames = frames_of(events);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(text_of(frames[0]), "a");
  EXPECT_EQ(text_of(frames[1]), "b");
}

TEST(InputQueue, TextAfterWhatMovesTheFocusWaitsForTheFocus) {
  for (const auto& [key, modifiers] :
       {std::pair{Key('P'), unsigned(kCtrl)}, {keys::kTab, 0u}, {keys::kEnter, 0u}}) {
    std::vector<InputEvent> events;
    strike_key(events, key, modifiers);
    strike(events, 'a');
    const auto frames = frames_of(events);
    ASSERT_EQ(frames.size(), 5u);  // the key, its release, two frames for nothing, the text
    EXPECT_EQ(text_of(frames[4]), "a");
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(text_of(frames[i]), "");
      for (const InputEvent& event : frames[i]) EXPECT_NE(event.key, 'A') << "a shortcut before the text";
    }
  }
}

TEST(InputQueue, AChordDoesNotSwallowTheTextBeforeIt) {
  std::vector<InputEvent> events;
  strike(events, 'a');
  strike_key(events, 'V', kCtrl);
  const auto frames = frames_of(events);
  ASSERT_GE(frames.size(), 2u);
  EXPECT_EQ(text_of(frames[0]), "a");
  for (const InputEvent& event : frames[0]) EXPECT_EQ(event.modifiers & kCtrl, 0u);
}

}  // namespace
}  // namespace sweepscope::ui
