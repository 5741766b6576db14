// What pages send and get.
#include "ui/serve/protocol.hpp"

#include <gtest/gtest.h>

namespace sweepscope::ui {
namespace {

template <typename Message>
Message read(const std::string& text) {
  const auto message = parse_page_message(text);
  EXPECT_TRUE(message) << text << ": " << (message ? "" : message.error().message);
  return message ? std::get<Message>(*message) : Message();
}

TEST(PageMessages, InputKeepsItsEventsInOrder) {
  const auto input = read<InputMessage>(
      R"({"type":"input","number":7,"events":[["move",10.5,20],["press",1,true,1],["wheel",-2],)"
      R"(["key","Enter",true,2],["text","ä"]]})");
  EXPECT_EQ(input.number, 7U);
  ASSERT_EQ(input.events.size(), 5U);
  EXPECT_EQ(input.events[0].x, 10.5);
  EXPECT_EQ(input.events[1].button, 1);
  EXPECT_TRUE(input.events[1].down);
  EXPECT_EQ(input.events[1].modifiers, unsigned{kShift});
  EXPECT_EQ(input.events[2].wheel, -2);
  EXPECT_EQ(input.events[3].key, keys::kEnter);
  EXPECT_EQ(input.events[4].text, "ä");
}

TEST(PageMessages, NumbersAreLimited) {
  const auto size = read<SizeMessage>(R"({"type":"size","width":1e9,"height":-5,"scale":1e300})");
  EXPECT_EQ(size.width_px, kMaxServedSide_px);
  EXPECT_EQ(size.height_px, kMinServedSide_px);
  EXPECT_EQ(size.scale, 4);
  const auto input =
      read<InputMessage>(R"({"type":"input","number":-3,"events":[["wheel",1e9],["press",9,true,99]]})");
  EXPECT_EQ(input.number, 0U);
  EXPECT_EQ(input.events.at(0).wheel, 50);
  EXPECT_EQ(input.events.at(1).button, 2);
  EXPECT_EQ(input.events.at(1).modifiers, 7U);
}

TEST(PageMessages, AFileIsAnnouncedByNameAndSize) {
  const auto upload = read<UploadMessage>(R"({"type":"upload","name":"run 7.bag","size_bytes":5000000000})");
  EXPECT_EQ(upload.name, "run 7.bag");
  EXPECT_EQ(upload.size_bytes, 5000000000U);
}

TEST(PageMessages, ControlCharactersAreLeftOut) {
  EXPECT_EQ(
      read<InputMessage>(R"({"type":"input","events":[["text","a\u0000\u001bb\n"]]})").events.at(0).text,
      "ab");
  EXPECT_EQ(read<PasteMessage>(R"({"type":"paste","text":"a\u0000\nb"})").text, "a\nb");
}

TEST(PageMessages, WhatIsNotInTheProtocolIsRefused) {
  std::string many = R"({"type":"input","events":[["wheel",1])";
  for (int i = 0; i < 64; ++i) many += R"(,["wheel",1])";
  for (const std::string& text :
       {std::string(),
        std::string("[]"),
        std::string("{}"),
        std::string(R"({"type":5})"),
        std::string(R"({"type":"open","file":"/etc/passwd"})"),
        std::string(R"({"type":"input"})"),
        std::string(R"({"type":"input","events":[["drop","/etc/passwd"]]})"),
        std::string(R"({"type":"input","events":[["move",1]]})"),
        std::string(R"({"type":"input","events":[["move","1",2]]})"),
        std::string(R"({"type":"input","events":[["key","Ctrl+Q",true,0]]})"),
        std::string(R"({"type":"input","events":[["key","Meta",true,0]]})"),
        std::string("{\"type\":\"paste\",\"text\":\"\xff\xfe\"}"),
        std::string(R"({"type":"control","what":"take"})"),
        std::string(R"({"type":"upload","name":"a"})"),
        std::string(R"({"type":"upload","name":5,"size_bytes":1})"),
        std::string(R"({"type":"upload","name":"a","size_bytes":-1})"),
        std::string(R"({"type":"upload","name":"a","size_bytes":1.5})"),
        std::string(R"({"type":"upload","name":"a","size_bytes":1e300})"),
        R"({"type":"upload","name":")" + std::string(2000, 'a') + R"(","size_bytes":1})",
        R"({"type":"paste","text":")" + std::string(40000, 'a') + "\"}",
        many + "]}",
        std::string(kMaxPageMessage_bytes + 1, ' '),
        std::string(60000, '[')})
    EXPECT_FALSE(parse_page_message(text)) << text.substr(0, 80);
}

TEST(Frames, BytesAreAsThePageReadsThem) {
  const std::string bytes = to_bytes({1,
                                      0x01020304,
                                      3,
                                      4,
                                      5,
                                      6,
                                      1280,
                                      720,
                                      true,
                                      false,
                                      {{{32, 64, 5, 6}, FramePart::Format::kPng, "abc"}}});
  ASSERT_EQ(bytes.size(), 32U + 14 + 3);
  EXPECT_EQ(bytes.substr(4, 4), std::string("\x04\x03\x02\x01"));
  EXPECT_EQ(bytes.substr(24, 8), std::string("\x00\x05\xd0\x02\x01\x00\x01\x00", 8));
  EXPECT_EQ(bytes.substr(32), std::string("\x20\0\x40\0\x05\0\x06\0\x01\0\x03\0\0\0abc", 17));
}

}  // namespace
}  // namespace sweepscope::ui
