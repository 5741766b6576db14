'use strict';
// Pictures as the program sends them: see ui/serve/protocol.hpp.

const FRAME_TYPES = ['image/jpeg', 'image/png'];

function decodeFrame(buffer) {
  const view = new DataView(buffer);
  const frame = {
    number: view.getUint32(0, true), input: view.getUint32(4, true), wait_us: view.getUint32(8, true),
    draw_us: view.getUint32(12, true), held_us: view.getUint32(16, true), encode_us: view.getUint32(20, true),
    width: view.getUint16(24, true), height: view.getUint16(26, true),
    exact: (view.getUint16(28, true) & 1) !== 0, atRest: (view.getUint16(28, true) & 2) !== 0,
    bytes: buffer.byteLength, parts: [],
  };
  let at = 32;
  for (let count = view.getUint16(30, true); count > 0; --count) {
    const [left, top, width, height, format] = [0, 2, 4, 6, 8].map((offset) => view.getUint16(at + offset, true));
    const size = view.getUint32(at + 10, true);
    frame.parts.push({left, top, width, height, type: FRAME_TYPES[format], data: new Uint8Array(buffer, at + 14, size)});
    at += 14 + size;
  }
  return frame;
}

/** What drawImage takes. A Blob goes through other processes of the browser: several times as long, where it can be avoided. */
async function decodePart(part) {
  const as_drawn = {colorSpaceConversion: 'none', premultiplyAlpha: 'none'};
  if (typeof ImageDecoder === 'undefined') return createImageBitmap(new Blob([part.data], {type: part.type}), as_drawn);
  const decoder = new ImageDecoder({data: part.data, type: part.type, ...as_drawn});
  try {
    return (await decoder.decode()).image;
  } finally {
    decoder.close();
  }
}

/** Draws frames one after the other, each whole, and tells when one is on the canvas. */
class FramePainter {
  constructor(canvas, shown) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {alpha: false});
    this.shown = shown;
    this.last = Promise.resolve();
  }

  paint(buffer) {
    const frame = decodeFrame(buffer);
    frame.cameAt = performance.now();
    const bitmaps = Promise.all(frame.parts.map(decodePart));
    this.last = this.last.then(() => bitmaps).then((pictures) => {
      frame.decodedAt = performance.now();
      this.draw(frame, pictures);
    });
    return this.last;
  }

  draw(frame, pictures) {
    if (this.canvas.width !== frame.width || this.canvas.height !== frame.height) {
      this.canvas.width = frame.width;
      this.canvas.height = frame.height;
    }
    pictures.forEach((picture, i) => {
      this.context.drawImage(picture, frame.parts[i].left, frame.parts[i].top);
      picture.close();
    });
    this.shown(frame);
  }
}
