#include "core/recording/ros1/ros1_bag.hpp"

#include <lz4frame.h>
#include <rosbag/view.h>

#include <algorithm>
#include <tuple>

#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

using test::RawBag;

struct Visited {
  std::string topic, type, bytes;
  std::int64_t receive_ns = 0;
  std::string place;
};

struct Reading {
  Result<std::vector<std::string>> warnings = std::vector<std::string>();
  std::vector<Visited> messages;

  std::string all_warnings() const {
    std::string all;
    for (const std::string& warning : *warnings) all += warning + "\n";
    return all;
  }
};

Reading read(const std::filesystem::path& path) {
  Reading reading;
  const auto visit = [&](const BagMessage& message) -> std::optional<Error> {
    reading.messages.push_back(
        {message.connection.topic, message.connection.type,
         std::string(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size()),
         message.receive_ns, message.place.text()});
    return std::nullopt;
  };
  reading.warnings = read_ros1_bag(path, visit, Job());
  return reading;
}

/// A bag of these records after a sound beginning, read.
Reading read_records(const test::ScratchFolder& folder, const std::string& records,
                     std::uint64_t index_at = 0) {
  test::write_file(folder / "raw.bag", RawBag::magic() + RawBag::bag_header(index_at) + records);
  return read(folder / "raw.bag");
}

std::string sample_chunk_records() {
  return RawBag::connection(7, "/a", "x/Y") + RawBag::message(7, 3, "one") + RawBag::message(7, 4, "two");
}

class EveryCompression : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Ros1Bag, EveryCompression, testing::Values("none", "bz2", "lz4"));

TEST_P(EveryCompression, GivesTheSameMessagesAsTheReferenceReader) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag", GetParam());
  Reading reading = read(folder / "a.bag");
  ASSERT_TRUE(reading.warnings);
  EXPECT_EQ(reading.all_warnings(), "");
  rosbag::Bag reference(folder / "a.bag", rosbag::bagmode::Read);
  std::vector<Visited> expected;
  for (const rosbag::MessageInstance& message : rosbag::View(reference)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    expected.push_back({message.getTopic(), message.getDataType(), bytes,
                        static_cast<std::int64_t>(message.getTime().toNSec()), ""});
  }
  const auto key = [](const Visited& message) { return std::tie(message.receive_ns, message.topic); };
  std::ranges::sort(reading.messages, {}, key);
  std::ranges::sort(expected, {}, key);
  ASSERT_EQ(reading.messages.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(reading.messages[i].receive_ns, expected[i].receive_ns);
    EXPECT_EQ(reading.messages[i].topic, expected[i].topic);
    EXPECT_EQ(reading.messages[i].type, expected[i].type);
    EXPECT_EQ(reading.messages[i].bytes, expected[i].bytes);
  }
}

TEST_P(EveryCompression, GivesWhatIsWholeHoweverItIsCut) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag", GetParam());
  const std::string whole = test::contents_of(folder / "a.bag");
  const std::size_t all = read(folder / "a.bag").messages.size();
  std::size_t before = 0;
  for (std::size_t bytes = 13; bytes < whole.size(); bytes += 1 + whole.size() / 300) {
    test::write_file(folder / "cut.bag", whole.substr(0, bytes));
    const Reading reading = read(folder / "cut.bag");
    ASSERT_TRUE(reading.warnings) << "cut at " << bytes;
    EXPECT_FALSE(reading.warnings->empty()) << "cut at " << bytes;
    EXPECT_GE(reading.messages.size(), before) << "cut at " << bytes;
    EXPECT_LE(reading.messages.size(), all) << "cut at " << bytes;
    before = reading.messages.size();
  }
  EXPECT_EQ(before, all);
}

TEST_P(EveryCompression, ReadsABagThatWasNeverClosed) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag", GetParam());
  std::string bytes = test::contents_of(folder / "a.bag");
  const auto index = bytes.find("index_pos=");
  std::uint64_t index_at = 0;
  std::memcpy(&index_at, bytes.data() + index + 10, 8);
  bytes.replace(index + 10, 8, 8, '\0');
  test::write_file(folder / "open.bag", bytes.substr(0, index_at));
  const Reading reading = read(folder / "open.bag");
  ASSERT_TRUE(reading.warnings);
  EXPECT_EQ(reading.messages.size(), std::size_t{test::kSampleScans + test::kSampleMotor});
  EXPECT_NE(reading.all_warnings().find("never closed"), std::string::npos);
}

TEST_P(EveryCompression, SurvivesAnyFlippedByte) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag", GetParam());
  std::string bytes = test::contents_of(folder / "a.bag");
  for (std::size_t i = 13; i < bytes.size(); i += 1 + bytes.size() / 400) {
    const char kept = bytes[i];
    bytes[i] = static_cast<char>(~kept);
    test::write_file(folder / "flipped.bag", bytes);
    bytes[i] = kept;
    const Reading reading = read(folder / "flipped.bag");
    EXPECT_TRUE(reading.warnings || reading.warnings.error().code == ExitCode::kUnreadableInput)
        << "byte " << i;
    EXPECT_LE(reading.messages.size(), std::size_t{test::kSampleScans + test::kSampleMotor}) << "byte " << i;
  }
}

TEST(Ros1Bag, NamesThePlaceOfTheCut) {
  const test::ScratchFolder folder;
  const std::string chunk = RawBag::chunk("none", 0, sample_chunk_records());
  const std::string start = RawBag::magic() + RawBag::bag_header(0);
  test::write_file(folder / "cut.bag", start + chunk.substr(0, chunk.size() - 1));
  const Reading reading = read(folder / "cut.bag");
  ASSERT_EQ(reading.messages.size(), 1U);
  EXPECT_NE(
      reading.all_warnings().find("cut short: the record at byte " + std::to_string(start.size()) + " "),
      std::string::npos)
      << reading.all_warnings();
}

TEST(Ros1Bag, ReadsConnectionsAndMessagesOutsideOfChunks) {
  const test::ScratchFolder folder;
  const Reading reading = read_records(folder, sample_chunk_records());
  ASSERT_EQ(reading.messages.size(), 2U);
  EXPECT_EQ(reading.messages[1].bytes, "two");
  EXPECT_EQ(reading.messages[1].receive_ns, 4'000'000'000);
}

TEST(Ros1Bag, TakesConnectionsFromTheIndexWhereTheirChunkIsDamaged) {
  const test::ScratchFolder folder;
  const std::string damaged = RawBag::chunk("bz2", 100, "no bz2 data");
  const std::string message = RawBag::message(7, 3, "one");
  const std::string sound = RawBag::chunk("none", message.size(), message);
  const std::uint64_t index_at = (RawBag::magic() + RawBag::bag_header(0) + damaged + sound).size();
  const Reading reading =
      read_records(folder, damaged + sound + RawBag::connection(7, "/a", "x/Y"), index_at);
  ASSERT_EQ(reading.messages.size(), 1U);
  EXPECT_EQ(reading.messages[0].topic, "/a");
  EXPECT_NE(reading.all_warnings().find("is damaged (its bz2 data is damaged)"), std::string::npos);
}

TEST(Ros1Bag, SkipsMessagesOfUnknownConnections) {
  const test::ScratchFolder folder;
  const Reading reading = read_records(folder, RawBag::message(9, 3, "lost") + sample_chunk_records());
  EXPECT_EQ(reading.messages.size(), 2U);
  EXPECT_NE(reading.all_warnings().find("belongs to no connection"), std::string::npos);
}

TEST(Ros1Bag, TrustsNoSizeThatAChunkClaims) {
  const test::ScratchFolder folder;
  const std::string records = sample_chunk_records();
  const std::string wrong = RawBag::chunk("none", 0xFFFFFFFF, records);
  const Reading reading = read_records(folder, wrong);
  EXPECT_EQ(reading.messages.size(), 2U);
  EXPECT_NE(reading.all_warnings().find("claims 4294967295 unpacked bytes"), std::string::npos);
}

TEST(Ros1Bag, DamageInAChunkCostsTheRestOfThatChunkOnly) {
  const test::ScratchFolder folder;
  const std::string records = sample_chunk_records() + RawBag::number(0xFFFFFFF0, 4) + "rubbish";
  const std::string good = RawBag::message(7, 5, "three");
  const Reading reading = read_records(
      folder, RawBag::chunk("none", records.size(), records) + RawBag::chunk("none", good.size(), good));
  ASSERT_EQ(reading.messages.size(), 3U);
  EXPECT_EQ(reading.messages[2].bytes, "three");
  EXPECT_NE(reading.all_warnings().find("no complete record at byte"), std::string::npos);
}

TEST(Ros1Bag, SkipsAChunkOfUnknownCompression) {
  const test::ScratchFolder folder;
  const std::string records = sample_chunk_records();
  const Reading reading = read_records(folder, RawBag::chunk("zip", records.size(), records) + records);
  EXPECT_EQ(reading.messages.size(), 2U);
  EXPECT_NE(reading.all_warnings().find("compressed as \"zip\""), std::string::npos);
}

TEST(Ros1Bag, RefusesAnEncryptedBag) {
  const test::ScratchFolder folder;
  test::write_file(folder / "a.bag",
                   RawBag::magic() + RawBag::record({"op=\x03", "encryptor=rosbag/AesCbcEncryptor"}, ""));
  const Reading reading = read(folder / "a.bag");
  ASSERT_FALSE(reading.warnings);
  EXPECT_NE(reading.warnings.error().message.find("encrypted"), std::string::npos);
}

TEST(Ros1Bag, AHeaderSizeBeyondTheFileEndsTheReading) {
  const test::ScratchFolder folder;
  const Reading huge =
      read_records(folder, sample_chunk_records() + RawBag::number(0xFFFFFFFF, 4) + "xxxxxxxx");
  EXPECT_EQ(huge.messages.size(), 2U);
  EXPECT_NE(huge.all_warnings().find("there is no record at byte"), std::string::npos);
  const Reading beyond = read_records(folder, sample_chunk_records() + RawBag::number(4096, 4) + "xxxxxxxx");
  EXPECT_NE(beyond.all_warnings().find("cut short in the record at byte"), std::string::npos);
}

/// A bag with an index after these records, at which it is seen to be whole.
Reading read_closed(const test::ScratchFolder& folder, const std::string& records,
                    const std::string& index = RawBag::connection(7, "/a", "x/Y")) {
  return read_records(folder, records + index, (RawBag::magic() + RawBag::bag_header(0) + records).size());
}

TEST(Ros1Bag, AWrongLengthInABagThatIsNotCutShortIsCalledThat) {
  const test::ScratchFolder folder;
  const std::string sound = sample_chunk_records();
  const std::string place = std::to_string((RawBag::magic() + RawBag::bag_header(0) + sound).size());
  std::string of_data = RawBag::message(7, 5, "three");
  of_data[of_data.size() - 7] = '\x01';  // 65,541 bytes and not 5
  const Reading data = read_closed(folder, sound + of_data);
  EXPECT_EQ(data.messages.size(), 2U);
  EXPECT_NE(data.all_warnings().find("the length of the record at byte " + place + " is damaged"),
            std::string::npos)
      << data.all_warnings();
  const Reading header = read_closed(folder, sound + RawBag::number(1 << 19, 4) + "xxxxxxxx");
  EXPECT_NE(header.all_warnings().find("a length is damaged in the record at byte " + place),
            std::string::npos)
      << header.all_warnings();
  for (const Reading* reading : {&data, &header})
    EXPECT_EQ(reading->all_warnings().find("it is cut short"), std::string::npos) << reading->all_warnings();
}

TEST(Ros1Bag, ReadingGoesOnBehindABlockOfZerosWithOneWarning) {
  for (const bool with_index : {true, false}) {
    const test::ScratchFolder folder;
    test::write_sample_bag(folder / "a.bag");
    std::string bytes = test::contents_of(folder / "a.bag");
    const std::size_t all = read(folder / "a.bag").messages.size();
    const std::size_t begin = bytes.size() / 3;
    bytes.replace(begin, 4096, 4096, '\0');
    if (!with_index) bytes.replace(bytes.find("index_pos=") + 10, 8, 8, '\0');
    test::write_file(folder / "zeroed.bag", bytes);
    const Reading reading = read(folder / "zeroed.bag");
    ASSERT_TRUE(reading.warnings);
    EXPECT_LT(reading.messages.size(), all);
    EXPECT_GT(reading.messages.size(), all * 9 / 10);
    ASSERT_EQ(reading.warnings->size(), with_index ? 1U : 2U) << reading.all_warnings();
    const std::string& warning = reading.warnings->front();
    EXPECT_NE(warning.find("record at byte "), std::string::npos) << warning;
    EXPECT_NE(warning.find(": nothing up to byte "), std::string::npos) << warning;
    EXPECT_NE(warning.find(" s after the first message"), std::string::npos) << warning;
  }
}

TEST(Ros1Bag, AChunkWhoseLengthReachesIntoTheNextIsReadUpToThat) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  std::string bytes = test::contents_of(folder / "a.bag");
  const std::size_t all = read(folder / "a.bag").messages.size();
  // The length of a chunk's data follows its header, of which `size` is the last field.
  const std::size_t length = bytes.find("size=", bytes.size() / 2) + 9;
  bytes[length + 1] = static_cast<char>(bytes[length + 1] + 0x20);
  test::write_file(folder / "long.bag", bytes);
  const Reading reading = read(folder / "long.bag");
  EXPECT_EQ(reading.messages.size(), all);
  EXPECT_NE(reading.all_warnings().find("the length of the record at byte"), std::string::npos)
      << reading.all_warnings();
}

TEST(Ros1Bag, AWrongOpCodeIsCalledThat) {
  const test::ScratchFolder folder;
  const std::string lost = RawBag::message(7, 5, "three");
  for (const char op : {'\x04', '\x05', '\x06', '\x07', '\x31'}) {
    std::string damaged = lost;
    damaged[damaged.find("op=") + 3] = op;
    for (const bool in_chunk : {false, true}) {
      const std::string record = in_chunk ? RawBag::chunk("none", damaged.size(), damaged) : damaged;
      const Reading reading = read_closed(folder, sample_chunk_records() + record);
      EXPECT_EQ(reading.messages.size(), 2U);
      EXPECT_NE(reading.all_warnings().find("its op code, " + std::to_string(int(op)) + ","),
                std::string::npos)
          << int(op) << ": " << reading.all_warnings();
    }
  }
}

TEST(Ros1Bag, AConnectionThatTheIndexDescribesOtherwiseIsNamed) {
  const test::ScratchFolder folder;
  const Reading reading =
      read_closed(folder, sample_chunk_records(), RawBag::connection(7, "/a", "x/Y", "of another version"));
  EXPECT_NE(reading.all_warnings().find("one of the two is damaged"), std::string::npos)
      << reading.all_warnings();
}

/// Zeros that lz4 packs some two hundred times smaller.
std::string packed_zeros(std::size_t mebibytes) {
  const std::string zeros(std::size_t{1} << 20, '\0');
  std::string part(2 * zeros.size(), '\0'), packed;
  LZ4F_cctx* context = nullptr;
  LZ4F_createCompressionContext(&context, LZ4F_VERSION);
  packed.append(part.data(), LZ4F_compressBegin(context, part.data(), part.size(), nullptr));
  for (std::size_t i = 0; i < mebibytes; ++i) {
    packed.append(part.data(), LZ4F_compressUpdate(context, part.data(), part.size(), zeros.data(),
                                                   zeros.size(), nullptr));
  }
  packed.append(part.data(), LZ4F_compressEnd(context, part.data(), part.size(), nullptr));
  LZ4F_freeCompressionContext(context);
  return packed;
}

TEST(Ros1Bag, ACompressionBombStopsAtTheLimit) {
  const test::ScratchFolder folder;
  const std::string bomb = packed_zeros((kMaxChunk_bytes >> 20) + 1);
  ASSERT_LT(bomb.size(), 2U << 20);
  const Reading reading =
      read_records(folder, RawBag::chunk("lz4", kMaxChunk_bytes, bomb) + sample_chunk_records());
  EXPECT_EQ(reading.messages.size(), 2U);
  EXPECT_NE(reading.all_warnings().find("it unpacks to more than 268435456 bytes"), std::string::npos)
      << reading.all_warnings();
}

TEST(Ros1Bag, StopsWhereTheVisitorSaysSo) {
  const test::ScratchFolder folder;
  test::write_file(folder / "a.bag", RawBag::magic() + RawBag::bag_header(0) + sample_chunk_records());
  int visits = 0;
  const auto visit = [&](const BagMessage&) -> std::optional<Error> {
    ++visits;
    return Error{ExitCode::kUnreadableInput, "enough"};
  };
  const auto result = read_ros1_bag(folder / "a.bag", visit, Job());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "enough");
  EXPECT_EQ(visits, 1);
}

TEST(Ros1Bag, IsInterrupted) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  Job job;
  job.cancel();
  const auto result = read_ros1_bag(
      folder / "a.bag", [](const BagMessage&) { return std::nullopt; }, job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kInterrupted);
}

}  // namespace
}  // namespace sweepscope
