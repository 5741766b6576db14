// Writes a ROS 1 bag's scans, joint states and transforms in other formats, with libraries that are not this
// project's: node bag_to_ros2.mjs IN.bag OUT_FOLDER. See README.md.
import {createRequire} from "node:module";
import {mkdirSync, writeFileSync} from "node:fs";
import {McapWriter} from "@mcap/core";
import {parse} from "@foxglove/rosmsg";
import {MessageWriter as Ros2Writer} from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import lz4 from "lz4-napi";
import initSql from "sql.js";
const require = createRequire(import.meta.url);
const {Bag} = require("@foxglove/rosbag");
const {FileReader} = require("@foxglove/rosbag/node");
const Bzip2 = require("@foxglove/wasm-bz2");

const [source, out] = process.argv.slice(2);
for (const folder of ["mcap", "ros2", "packed_file", "packed_messages"])
  mkdirSync(`${out}/${folder}`, {recursive: true});
await zstd.isLoaded;
const bz2 = await Bzip2.init();
const bag = new Bag(new FileReader(source), {
  decompress: {
    bz2: (bytes, size) => bz2.decompress(bytes, size, {small: false}),
    lz4: (bytes) => lz4.decompressFrameSync(Buffer.from(bytes)),
  },
});
await bag.open();
const messages = [];
for await (const message of bag.messageIterator({})) messages.push(message);

const line = "=".repeat(80);
const types = new Map([["sensor_msgs/LaserScan", "sensor_msgs/msg/LaserScan"],
  ["sensor_msgs/JointState", "sensor_msgs/msg/JointState"],
  ["tf/tfMessage", "tf2_msgs/msg/TFMessage"], ["tf2_msgs/TFMessage", "tf2_msgs/msg/TFMessage"]]);
const connections = [...bag.connections.values()].filter((c) => types.has(c.type));
const ros2Definition = (text) => text.replace(/^uint32 seq\s*$/gm, "")
  .replace(/\btime\b(?=\s+\w+)/g, "builtin_interfaces/Time").replace(/^Header header/gm, "std_msgs/Header header") +
  `\n${line}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`;
const writers = new Map(connections.map(
  (c) => [c.conn, new Ros2Writer(parse(ros2Definition(c.messageDefinition), {ros2: true}))]));

/** A message's value with ROS 2's names in its times. */
function ros2Value(value) {
  if (value === null || typeof value !== "object" || ArrayBuffer.isView(value)) return value;
  if (Array.isArray(value)) return value.map(ros2Value);
  if ("nsec" in value) return {sec: value.sec, nanosec: value.nsec};
  return Object.fromEntries(Object.entries(value).map(([name, part]) => [name, ros2Value(part)]));
}
const nanoseconds = (time) => BigInt(time.sec) * 1_000_000_000n + BigInt(time.nsec);
const cdr = (message) => writers.get(message.connectionId).writeMessage(ros2Value(message.message));

async function writeMcap(name, ros2, options) {
  const parts = [];
  let bytes = 0n;
  const writable = {
    position: () => bytes,
    write: async (part) => { parts.push(Buffer.from(part)); bytes += BigInt(part.length); },
  };
  const writer = new McapWriter({writable, ...options});
  await writer.start({profile: ros2 ? "ros2" : "ros1", library: "mcap typescript reference"});
  const channels = new Map();
  for (const c of connections) {
    const schemaId = await writer.registerSchema({
      name: ros2 ? types.get(c.type) : c.type, encoding: ros2 ? "ros2msg" : "ros1msg",
      data: new TextEncoder().encode(ros2 ? ros2Definition(c.messageDefinition) : c.messageDefinition)});
    channels.set(c.conn, await writer.registerChannel({
      schemaId, topic: c.topic, messageEncoding: ros2 ? "cdr" : "ros1", metadata: new Map([["md5sum", c.md5sum]])}));
  }
  let sequence = 0;
  for (const message of messages) {
    if (!channels.has(message.connectionId)) continue;
    const time = nanoseconds(message.timestamp);
    await writer.addMessage({channelId: channels.get(message.connectionId), sequence: sequence++, logTime: time,
      publishTime: time, data: ros2 ? cdr(message) : message.data});
  }
  await writer.end();
  writeFileSync(name, Buffer.concat(parts));
}

/** The bytes of an SQLite database; `packed` is done to each message. */
async function database(packed) {
  const tables = new (await initSql()).Database();
  tables.run(`CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
      serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
      data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);`);
  for (const c of connections)
    tables.run("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", [c.conn + 1, c.topic, types.get(c.type)]);
  const insert = tables.prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)");
  for (const message of messages)
    if (writers.has(message.connectionId))
      insert.run([message.connectionId + 1, nanoseconds(message.timestamp).toString(), packed(cdr(message))]);
  return Buffer.from(tables.export());
}

await writeMcap(`${out}/ros2.mcap`, true, {});
await writeMcap(`${out}/ros1.mcap`, false,
  {compressChunk: (chunk) => ({compression: "lz4", compressedData: lz4.compressFrameSync(Buffer.from(chunk))})});
await writeMcap(`${out}/mcap/ros2_0.mcap`, true,
  {compressChunk: (chunk) => ({compression: "zstd", compressedData: zstd.compress(chunk, 3)})});
/** A ROS 2 bag's folder, as rosbag2 leaves it. */
function writeFolder(folder, file, bytes, mode) {
  writeFileSync(`${out}/${folder}/${file}`, bytes);
  writeFileSync(`${out}/${folder}/metadata.yaml`, `rosbag2_bagfile_information:
  version: 5
  storage_identifier: sqlite3
  relative_file_paths:
    - ${file}
  compression_format: "${mode ? "zstd" : ""}"
  compression_mode: "${mode}"
`);
}

const plain = await database((message) => message);
writeFolder("ros2", "ros2_0.db3", plain, "");
writeFolder("packed_file", "ros2_0.db3.zstd", zstd.compress(plain, 1), "FILE");
writeFolder("packed_messages", "ros2_0.db3", await database((message) => zstd.compress(message, 1)), "MESSAGE");
