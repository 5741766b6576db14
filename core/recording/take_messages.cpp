#include "core/recording/take_messages.hpp"

#include <utility>

namespace sweepscope {
RawLaser without_scans(const RawLaser& laser) {
  RawLaser known;
  known.topic = laser.topic;
  known.frame = laser.frame;
  known.other_frames = laser.other_frames;
  known.of_clouds = laser.of_clouds;
  known.of_echoes = laser.of_echoes;
  known.has_intensities = laser.has_intensities;
  return known;
}

RawJoint without_samples(const RawJoint& joint) {
  RawJoint known;
  known.topic = joint.topic;
  known.joint = joint.joint;
  known.source = joint.source;
  known.publishers = joint.publishers;
  return known;
}

RawRecording take_messages(RawRecording& growing) {
  RawRecording rest;
  rest.file = growing.file;
  rest.name = growing.name;
  rest.topics = growing.topics;
  rest.frames = growing.frames;
  for (const RawLaser& laser : growing.lasers) rest.lasers.push_back(without_scans(laser));
  for (const RawJoint& joint : growing.joints) rest.joints.push_back(without_samples(joint));
  return std::exchange(growing, std::move(rest));
}

}  // namespace sweepscope
