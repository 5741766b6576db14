// A server made of npm's Foxglove packages that plays an MCAP file, to try `calibrate foxglove` by hand:
//   npm install @foxglove/ws-protocol @mcap/core ws
//   node foxglove_server.mjs FILE.mcap [SUBPROTOCOL [CUT_AFTER]] &
//   sweepscope calibrate foxglove ws://localhost:8765
// SUBPROTOCOL: foxglove.websocket.v1 (default) or foxglove.sdk.v1. CUT_AFTER: the connection is cut after that many
// messages, once; the next client gets the rest.
import { readFile } from "node:fs/promises";
import foxglove from "@foxglove/ws-protocol";
import { McapStreamReader } from "@mcap/core";
import { WebSocketServer } from "ws";

const [file, subprotocol = "foxglove.websocket.v1", cutAfter = "0"] = process.argv.slice(2);
const reader = new McapStreamReader();
reader.append(await readFile(file));
const schemas = new Map(), channels = new Map(), messages = [];
for (let record; (record = reader.nextRecord()); ) {
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel") channels.set(record.id, record);
  if (record.type === "Message") messages.push(record);
}

const server = new foxglove.FoxgloveServer({ name: "sweepscope test" });
const numbers = new Map();
for (const [id, channel] of channels) {
  const schema = schemas.get(channel.schemaId);
  numbers.set(id, server.addChannel({
    topic: channel.topic,
    encoding: channel.messageEncoding,
    schemaName: schema.name,
    schema: new TextDecoder().decode(schema.data),
    schemaEncoding: schema.encoding,
  }));
}

let next = 0, subscribed = new Set(), cut = Number(cutAfter), client, playing;
function play() {
  for (let i = 0; i < 20 && next < messages.length; ++i, ++next) {
    if (cut > 0 && next >= cut) {
      cut = 0;
      clearInterval(playing);
      setTimeout(() => client.terminate(), 200); // what was sent has arrived by then
      return;
    }
    const message = messages[next];
    server.sendMessage(numbers.get(message.channelId), message.logTime, message.data);
  }
  if (next >= messages.length) clearInterval(playing);
}
server.on("subscribe", (id) => {
  subscribed.add(id);
  if (subscribed.size === numbers.size) playing = setInterval(play, 5);
});
server.on("unsubscribe", (id) => subscribed.delete(id));

const sockets = new WebSocketServer({
  port: 8765,
  handleProtocols: (offered) => (offered.has(subprotocol) ? subprotocol : false),
});
sockets.on("connection", (socket, request) => {
  client = socket;
  server.handleConnection(socket, request.socket.remoteAddress);
});
