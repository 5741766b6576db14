'use strict';
// The measured beams and what places them at an offset, on the graphics card. The layout of the data is that of
// render/page/packed_map.hpp.

const kTextureWidth = 1024;

function decodeBase64(text) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

function readBeams() {
  const head = JSON.parse(document.getElementById('live-head').textContent);
  const element = document.getElementById('live-data'), bytes = decodeBase64(element.textContent);
  element.remove();
  const array = (Type, name) => {
    const [begin, size] = head.arrays[name];
    return new Type(bytes.buffer, begin, size / Type.BYTES_PER_ELEMENT);
  };
  const data = {head};
  data.words = array(Uint32Array, 'beams');
  data.scans = array(Float64Array, 'scans');
  data.counts = array(Uint32Array, 'counts');
  data.motor = array(Float64Array, 'motor');
  data.sweeps = array(Float64Array, 'sweeps');
  data.path = array(Float64Array, 'path');
  data.knots = array(Float32Array, 'knots');
  data.count = data.words.length / 3;
  data.poseOfSweep = new Map();
  for (let i = 0; i < data.path.length; i += 4) data.poseOfSweep.set(data.path[i], i / 4 + 1);
  for (const one of head.colourings) {
    one.colours = decodeBase64(one.table);
    for (const level of one.given) {
      const bytes = array(Uint8Array, level.array);
      level.indices = one.by === 'features' ? featureIndices(bytes, data.count) : bytes;
    }
  }
  return data;
}

// Of each beam its place in the table of colours, from four kinds a byte: none, edge, plane.
function featureIndices(packed, count) {
  const indices = new Uint8Array(count);
  for (let i = 0; i < count; ++i) indices[i] = Math.floor(((packed[i >> 2] >> 2 * (i & 3) & 3) + 0.5) * 256 / 3);
  return indices;
}

// Of each beam its place in the table of colours, for a colouring that the program computed. Of several offsets those
// next to this one count, between them in proportion; place 0 is for what has no value.
function givenIndices({given}, offset_ms, indices) {
  const next = given.findIndex((level) => level.offset_ms >= offset_ms);
  if (given.length === 1 || next === 0) return indices.set(given[0].indices);
  if (next < 0) return indices.set(given[given.length - 1].indices);
  const [a, b] = [given[next - 1], given[next]], part = (offset_ms - a.offset_ms) / (b.offset_ms - a.offset_ms);
  for (let i = 0; i < indices.length; ++i) {
    const from = a.indices[i], to = b.indices[i];
    indices[i] = from > 0 && to > 0 ? Math.round(from + part * (to - from)) : part < 0.5 ? from : to;
  }
}

function makeProgram(gl, vertex, fragment, outputs) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      throw new Error(gl.getShaderInfoLog(shader));
  }
  if (outputs) gl.transformFeedbackVaryings(program, outputs, gl.INTERLEAVED_ATTRIBS);
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
    throw new Error(gl.getProgramInfoLog(program));
  const uniforms = new Map();
  return {program, at: (name) => {
    if (!uniforms.has(name)) uniforms.set(name, gl.getUniformLocation(program, name));
    return uniforms.get(name);
  }};
}

// A texture of `channels` numbers a texel, row by row.
function makeTable(gl, numbers, channels) {
  const floats = numbers instanceof Float32Array, texels = numbers.length / channels;
  const rows = Math.max(1, Math.ceil(texels / kTextureWidth));
  const padded = new numbers.constructor(rows * kTextureWidth * channels);
  padded.set(numbers);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  const [internal, format] = floats ? [gl.RGBA32F, gl.RGBA]
      : channels === 1 ? [gl.R32UI, gl.RED_INTEGER] : [gl.RGBA32UI, gl.RGBA_INTEGER];
  gl.texImage2D(gl.TEXTURE_2D, 0, internal, kTextureWidth, rows, 0, format, floats ? gl.FLOAT : gl.UNSIGNED_INT,
                padded);
  return texture;
}

function floatBits(value) {
  floatBits.float[0] = value;
  return floatBits.bits[0];
}
floatBits.float = new Float32Array(1);
floatBits.bits = new Uint32Array(floatBits.float.buffer);

// The motor's samples, and for runs of ticks the sample to begin at.
function motorTables(data) {
  const {tick_s, motor_origin_s} = data.head, count = data.motor.length / 2;
  const samples = new Uint32Array(4 * count);
  for (let i = 0; i < count; ++i) {
    const angle = data.motor[2 * i + 1], next = i + 1 < count ? data.motor[2 * i + 3] : angle;
    samples[4 * i] = Math.round((data.motor[2 * i] - motor_origin_s) / tick_s);
    samples[4 * i + 1] = floatBits(Math.sin(angle));
    samples[4 * i + 2] = floatBits(Math.cos(angle));
    samples[4 * i + 3] = floatBits(next - angle);
  }
  const last = samples[4 * (count - 1)];
  let bits = 0;
  while (last / 2 ** bits > 2 * count) ++bits;
  const first = new Uint32Array(Math.floor(last / 2 ** bits) + 2);
  for (let run = 0, i = 0; run < first.length; ++run) {
    while (i + 2 < count && samples[4 * (i + 1)] <= run * 2 ** bits) ++i;
    first[run] = i;
  }
  return {samples, first, bits, count};
}

function turnBetween(a, b) {  // the rotation vector from quaternion a to b, in the axes of a
  const [ax, ay, az, aw] = a, [bx, by, bz, bw] = b;
  let x = aw * bx - ax * bw - ay * bz + az * by, y = aw * by + ax * bz - ay * bw - az * bx;
  let z = aw * bz - ax * by + ay * bx - az * bw, w = aw * bw + ax * bx + ay * by + az * bz;
  if (w < 0) [x, y, z, w] = [-x, -y, -z, -w];
  const sine = Math.hypot(x, y, z), factor = sine < 1e-12 ? 2 : 2 * Math.atan2(sine, w) / sine;
  return [factor * x, factor * y, factor * z];
}

// The poses, and the steps from knot to knot within them.
function pathTables(data) {
  const {tick_s, laser_origin_s} = data.head, poses = new Uint32Array(data.path.length), steps = [];
  const ticks = (time_s) => Math.round((time_s - laser_origin_s) / tick_s);
  for (let i = 0, knot = 0; i < data.path.length; i += 4) {
    const [, begin_s, end_s, knots] = data.path.subarray(i, i + 4);
    poses[i] = ticks(begin_s);  // modulo 2^32: signed in the shader
    poses[i + 1] = ticks(end_s) - ticks(begin_s);
    poses[i + 2] = steps.length / 16;
    poses[i + 3] = knots - 1;
    for (let k = 0; k + 1 < knots; ++k) {
      const at = (j) => data.knots.subarray(7 * (knot + j), 7 * (knot + j) + 7);
      const a = at(k), b = at(k + 1), turn = turnBetween(a.subarray(3), b.subarray(3));
      steps.push(a[3], a[4], a[5], a[6], a[0], a[1], a[2], b[0] - a[0], ...turn, b[1] - a[1], b[2] - a[2], 0, 0, 0);
    }
    knot += knots;
  }
  return {poses, steps: new Float32Array(steps)};
}

// Of each scan at an offset: the number of its pose from 1, or 0 where it has none; and whether its sweep is odd.
function scanPoses(data, offset_ms) {
  const table = new Uint32Array(4 * data.scans.length), {sweeps, scans} = data;
  for (let i = 0, sweep = 0; i < scans.length; ++i) {
    const middle_s = scans[i] + offset_ms * 1e-3;
    while (2 * sweep < sweeps.length && sweeps[2 * sweep + 1] <= middle_s) ++sweep;
    if (2 * sweep >= sweeps.length || sweeps[2 * sweep] > middle_s) continue;
    table[4 * i] = data.head.moving ? data.poseOfSweep.get(sweep) ?? 0 : 1;
    table[4 * i + 1] = sweep % 2;
  }
  return table;
}

// Places the beams at offsets. Each offset's points are in a buffer of the card: x, y, z, height above the sensor's
// path and direction, 5 floats each.
class Placer {
  static kStride = 20;

  constructor(gl, data) {
    this.gl = gl;
    this.data = data;
    this.shader = makeProgram(gl, document.getElementById('place-shader').textContent,
                              '#version 300 es\nvoid main() {}', ['v_point_m', 'v_height_m', 'v_direction']);
    this.makeTextures();
    this.makeInput();
    this.feedback = gl.createTransformFeedback();
  }

  makeTextures() {
    const {gl, data} = this, motor = motorTables(data), path = pathTables(data);
    this.motor = motor;
    this.textures = {
      u_motor: makeTable(gl, motor.samples, 4),
      u_first: makeTable(gl, motor.first, 1),
      u_poses: makeTable(gl, path.poses, 4),
      u_steps: makeTable(gl, path.steps, 4),
      u_scans: null,
    };
  }

  makeInput() {
    const {gl, data} = this, scanOf = new Uint32Array(data.count);
    for (let i = 0, first = 0; i < data.counts.length; first += data.counts[i++])
      scanOf.fill(i, first, first + data.counts[i]);
    this.words = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.words);
    gl.bufferData(gl.ARRAY_BUFFER, data.words, gl.STATIC_DRAW);
    const scans = gl.createBuffer();
    this.input = gl.createVertexArray();
    gl.bindVertexArray(this.input);
    this.integers('a_place', 2, 12, 0);
    this.integers('a_tick', 1, 12, 8);
    gl.bindBuffer(gl.ARRAY_BUFFER, scans);
    gl.bufferData(gl.ARRAY_BUFFER, scanOf, gl.STATIC_DRAW);
    this.integers('a_scan', 1, 4, 0);
    gl.bindVertexArray(null);
  }

  integers(name, size, stride, offset) {
    const {gl} = this, at = gl.getAttribLocation(this.shader.program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribIPointer(at, size, gl.UNSIGNED_INT, stride, offset);
  }

  makeBuffer() {
    const {gl} = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, Placer.kStride * this.data.count, gl.DYNAMIC_COPY);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    return buffer;
  }

  place(offset_ms, buffer) {
    const {gl, data, shader} = this, {head} = data;
    gl.useProgram(shader.program);
    if (this.textures.u_scans) gl.deleteTexture(this.textures.u_scans);
    this.textures.u_scans = makeTable(gl, scanPoses(data, offset_ms), 4);
    Object.entries(this.textures).forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(shader.at(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform3fv(shader.at('u_corner_m'), head.corner_m);
    gl.uniform3fv(shader.at('u_axis'), head.axis);
    gl.uniform1f(shader.at('u_step_m'), head.step_m);
    const shift_s = head.laser_origin_s - head.motor_origin_s + offset_ms * 1e-3;
    gl.uniform1i(shader.at('u_shift'), Math.round(shift_s / head.tick_s));
    gl.uniform1i(shader.at('u_run_bits'), this.motor.bits);
    gl.uniform1i(shader.at('u_samples'), this.motor.count);
    gl.uniform1i(shader.at('u_moving'), head.moving);
    gl.bindVertexArray(this.input);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, this.feedback);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, data.count);
    gl.endTransformFeedback();
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    gl.bindVertexArray(null);
  }

  // What was placed, read back from the card: 5 floats a beam.
  read(buffer) {
    const {gl} = this, points = new Float32Array(5 * this.data.count);
    gl.bindBuffer(gl.COPY_READ_BUFFER, buffer);
    gl.getBufferSubData(gl.COPY_READ_BUFFER, 0, points);
    gl.bindBuffer(gl.COPY_READ_BUFFER, null);
    return points;
  }
}
