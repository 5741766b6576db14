'use strict';
// Draws placed points without the graphics card's points: where WebGL is software, one of them takes microseconds, and
// a loop over all takes nanoseconds each. Same points, sizes, colours and depths as draw.vert.

const kComputed = ['elevation', 'direction', 'time'];  // the other colours are given with each beam
const kSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function isSoftware(gl) {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return kSoftware.test(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

class Splatter {
  constructor(gl, data) {
    this.gl = gl;
    this.data = data;
    this.placer = new LoopPlacer(data);
    this.maps = [{}, {}];
    this.shader = makeProgram(gl, `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`,
        `#version 300 es
precision mediump float;
uniform sampler2D u_picture;
out vec4 colour;
void main() { colour = texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0); }`);
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  // The points of a map, at its new offset.
  setOffset(map, offset_ms) {
    const one = this.maps[map];
    one.points = one.points ?? new Float32Array(5 * this.data.count);
    this.placer.place(offset_ms, one.points);
    one.offset_ms = offset_ms;
    one.colouring = -1;
  }

  // The place of each point in the table of colours.
  colourise(map, colouring) {
    if (map.colouring === colouring) return;
    const {head, words, count} = this.data, one = head.colourings[colouring], {points} = map;
    const by = kComputed.indexOf(one.by), zero_s = head.laser_origin_s - head.time_origin_s;
    map.colouring = colouring;
    map.indices = map.indices ?? new Uint8Array(count);
    if (by < 0) return givenIndices(one, map.offset_ms, map.indices);
    for (let i = 0; i < count; ++i) {
      const value = by === 0 ? points[5 * i + 2] : by === 1 ? points[5 * i + 4] : words[3 * i + 2] * head.tick_s + zero_s;
      const part = one.to > one.from ? (value - one.from) / (one.to - one.from) : 0.5;
      map.indices[i] = Math.floor(255 * Math.min(1, Math.max(0, part)) + 0.5);
    }
  }

  begin(width, height, background) {
    if (this.width !== width || this.height !== height) {
      this.width = width;
      this.height = height;
      this.picture = new Uint32Array(width * height);
      this.depth = new Float32Array(width * height);
    }
    this.picture.fill(background);
    this.depth.fill(-Infinity);
  }

  // `view` and `clip`: pixels, rows from the bottom. `camera`: axes, middle, and pixels per metre.
  drawMap(index, view, clip, camera, slabs, size, colours) {
    const map = this.maps[index], {points, indices} = map, {picture, depth, width, data} = this;
    const {axes, middle, scale} = camera, [rx, ry, rz] = axes.right, [ux, uy, uz] = axes.up, [bx, by, bz] = axes.back;
    const [mx, my, mz] = middle, [low0, high0, low1, high1] = slabs;
    const x0 = view.x + view.width / 2 - size / 2, y0 = view.y + view.height / 2 - size / 2, side = Math.round(size);
    const left = clip.x, right = clip.x + clip.width - side, bottom = clip.y, top = clip.y + clip.height - side;
    for (let i = 0, j = 0; i < data.count; ++i, j += 5) {
      const height = points[j + 3];
      if (!(height >= low0 && height <= high0) && !(height >= low1 && height <= high1)) continue;
      const x = points[j] - mx, y = points[j + 1] - my, z = points[j + 2] - mz;
      const px = Math.round(x0 + scale * (x * rx + y * ry + z * rz));
      if (px < left || px > right) continue;
      const py = Math.round(y0 + scale * (x * ux + y * uy + z * uz));
      if (py < bottom || py > top) continue;
      const near = x * bx + y * by + z * bz, colour = colours[indices[i]];
      for (let row = py * width + px, end = row + side * width; row < end; row += width) {
        for (let at = row; at < row + side; ++at) {
          if (near > depth[at]) {
            depth[at] = near;
            picture[at] = colour;
          }
        }
      }
    }
  }

  fill(clip, colour) {
    for (let y = clip.y; y < clip.y + clip.height; ++y)
      this.picture.fill(colour, y * this.width + clip.x, y * this.width + clip.x + Math.max(0, clip.width));
  }

  end() {
    const {gl, width, height} = this, bytes = new Uint8Array(this.picture.buffer);
    gl.disable(gl.SCISSOR_TEST);
    gl.disable(gl.DEPTH_TEST);
    gl.viewport(0, 0, width, height);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.useProgram(this.shader.program);
    gl.uniform1i(this.shader.at('u_picture'), 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
