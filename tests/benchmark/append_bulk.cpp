// Makes a bag large: appends messages that no estimate wants. Run by tests/benchmark/large-bags.
//   append_bulk BAG numbers COUNT     tiny messages, std_msgs/Float64
//   append_bulk BAG images MEGABYTES  sensor_msgs/Image of 2 MB each
#include <fmt/format.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Float64.h>

#include <cstdlib>
#include <string_view>

#include "tests/core/recording/message_allocator.hpp"

namespace {

using sweepscope::MessageAllocator;

ros::Time time_of(std::uint64_t number) {
  return {static_cast<std::uint32_t>(1'700'000'000 + number / 1000),
          static_cast<std::uint32_t>(number % 1000 * 1'000'000)};
}

void append_numbers(rosbag::Bag& bag, std::uint64_t count) {
  std_msgs::Float64_<MessageAllocator<void>> message;
  for (std::uint64_t i = 0; i < count; ++i) {
    message.data = static_cast<double>(i);
    bag.write("/bulk/number", time_of(i), message);
  }
}

void append_images(rosbag::Bag& bag, std::uint64_t megabytes) {
  sensor_msgs::Image_<MessageAllocator<void>> message;
  message.encoding = "mono8";
  message.width = message.step = 2048;
  message.height = 1024;
  message.data.assign(std::size_t{2} << 20, 7);
  for (std::uint64_t i = 0; i < megabytes / 2; ++i) bag.write("/bulk/image", time_of(i), message);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: append_bulk BAG numbers|images HOW_MANY\n");
    return 2;
  }
  rosbag::Bag bag(argv[1], rosbag::bagmode::Append);
  const std::uint64_t how_many = std::strtoull(argv[3], nullptr, 10);
  if (std::string_view(argv[2]) == "numbers")
    append_numbers(bag, how_many);
  else
    append_images(bag, how_many);
  bag.close();
  return 0;
}
