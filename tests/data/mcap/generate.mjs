// Writes the files beside it with the reference implementations; see README.md.
import {McapWriter} from "@mcap/core";
import {parse} from "@foxglove/rosmsg";
import {MessageWriter as Ros2Writer} from "@foxglove/rosmsg2-serialization";
import {MessageWriter as Ros1Writer} from "@foxglove/rosmsg-serialization";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4-napi";
import {writeFileSync} from "node:fs";

const line = "=".repeat(80);
const fields = {
  LaserScan: `float32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment
float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities`,
  JointState: "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort",
};
const definition = (type, ros2) => `std_msgs/Header header\n${fields[type]}\n${line}\nMSG: std_msgs/Header\n` +
  (ros2 ? `builtin_interfaces/Time stamp\nstring frame_id\n${line}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`
        : "uint32 seq\ntime stamp\nstring frame_id\n");

// One second: 40 scans of 5 beams, 120 motor samples from 0.1 s before to 0.1 s after, received 5 ms later.
const kStart_ns = 1001_000_000_000n;
function messages(ros2) {
  const header = (ns, frame_id) => {
    const sec = Number(ns / 1_000_000_000n), nsec = Number(ns % 1_000_000_000n);
    return ros2 ? {stamp: {sec, nanosec: nsec}, frame_id} : {seq: 0, stamp: {sec, nsec}, frame_id};
  };
  const all = [];
  for (let i = 0; i < 40; ++i) {
    const ns = kStart_ns + 25_000_000n * BigInt(i);
    all.push({type: "LaserScan", ns, value: {
      header: header(ns, "laser"), angle_min: -0.5, angle_max: 0.5, angle_increment: 0.25, time_increment: 0.001,
      scan_time: 0.025, range_min: 0.1, range_max: 30, ranges: [1, 2, 3, 4, 5 + i], intensities: [i, 0, 0, 0, 0]}});
  }
  for (let i = 0; i < 120; ++i) {
    const ns = kStart_ns + 10_000_000n * BigInt(i) - 100_000_000n;
    all.push({type: "JointState", ns, value: {
      header: header(ns, ""), name: ["roll_motor"], position: [0.01 * i], velocity: [], effort: []}});
  }
  return all.sort((a, b) => (a.ns < b.ns ? -1 : a.ns > b.ns ? 1 : 0));
}

async function write(name, ros2, options) {
  const parts = [];
  let bytes = 0n;
  const writable = {
    position: () => bytes,
    write: async (part) => { parts.push(Buffer.from(part)); bytes += BigInt(part.length); },
  };
  const writer = new McapWriter({writable, chunkSize: 4000, ...options});
  await writer.start({profile: ros2 ? "ros2" : "ros1", library: "mcap typescript reference"});
  const kinds = {};
  for (const [type, topic] of [["LaserScan", "/scan"], ["JointState", "/joint_states"]]) {
    const text = definition(type, ros2);
    const schemaId = await writer.registerSchema({
      name: ros2 ? `sensor_msgs/msg/${type}` : `sensor_msgs/${type}`, encoding: ros2 ? "ros2msg" : "ros1msg",
      data: new TextEncoder().encode(text)});
    const channelId = await writer.registerChannel({
      schemaId, topic, messageEncoding: ros2 ? "cdr" : "ros1", metadata: new Map([["note", "any"]])});
    const parsed = parse(text, {ros2});
    kinds[type] = {channelId, writer: ros2 ? new Ros2Writer(parsed) : new Ros1Writer(parsed)};
  }
  let sequence = 0;
  for (const {type, ns, value} of messages(ros2)) {
    const data = kinds[type].writer.writeMessage(value);
    await writer.addMessage({
      channelId: kinds[type].channelId, sequence: sequence++, logTime: ns + 5_000_000n, publishTime: ns, data});
  }
  await writer.end();
  writeFileSync(name, Buffer.concat(parts));
}

await zstd.isLoaded;
const packed = {
  lz4: (chunk) => ({compression: "lz4", compressedData: lz4.compressFrameSync(Buffer.from(chunk))}),
  zstd: (chunk) => ({compression: "zstd", compressedData: zstd.compress(chunk, 19)}),
};
const unindexed = {useMessageIndex: false, useChunkIndex: false, useStatistics: false, useSummaryOffsets: false,
  repeatSchemas: false, repeatChannels: false};
await write("ros2.mcap", true, {});
await write("ros2_lz4.mcap", true, {compressChunk: packed.lz4});
await write("ros2_zstd.mcap", true, {compressChunk: packed.zstd});
await write("ros2_zstd_unindexed.mcap", true, {compressChunk: packed.zstd, ...unindexed});
await write("ros2_unchunked.mcap", true, {useChunks: false, ...unindexed});
await write("ros1_lz4.mcap", false, {compressChunk: packed.lz4});
