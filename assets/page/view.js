'use strict';
// The panes: maps A and B seen by one camera, side by side, one above the other, or with a divider between them.

const kViews = {  // as the program names its keys; angles of the direction to the camera
  1: {name: 'Front', yaw: -90, pitch: 0},
  3: {name: 'Right', yaw: 0, pitch: 0},
  7: {name: 'Top', yaw: -90, pitch: 90},
  9: {name: 'Oblique', yaw: -45, pitch: 35.264},
};
const kRoom = 1.06;  // around what is shown
const kFragment = `#version 300 es
precision mediump float;
flat in vec4 v_colour;
out vec4 colour;
void main() { colour = v_colour; }`;

function axesOf(camera) {
  const yaw = camera.yaw * Math.PI / 180, pitch = camera.pitch * Math.PI / 180;
  const back = [Math.cos(pitch) * Math.cos(yaw), Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch)];
  const right = [-Math.sin(yaw), Math.cos(yaw), 0];
  const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
              back[0] * right[1] - back[1] * right[0]];
  return {right, up, back};
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// The half width and height of a box as a camera sees it.
function halfSeen(box, axes) {
  const half = [0, 1, 2].map((i) => (box[1][i] - box[0][i]) / 2);
  const along = (axis) => axis.reduce((sum, part, i) => sum + Math.abs(part) * half[i], 0);
  return [along(axes.right), along(axes.up), along(axes.back)];
}

class Scene {
  constructor(canvas, data) {
    this.canvas = canvas;
    this.data = data;
    const gl = canvas.getContext('webgl2', {antialias: false, alpha: false, powerPreference: 'high-performance'});
    if (!gl) throw new Error('no WebGL 2');
    this.gl = gl;
    this.placed = [NaN, NaN];
    if (isSoftware(gl)) this.splatter = new Splatter(gl, data);
    else this.useCard();
    this.layout = 'side';
    this.divider = 0.5;
    this.colouring = 0;
    this.camera = {middle: [0, 0, 0], ...kViews[7], height: 10, fitted: 7};
  }

  // Places and draws by the graphics card from here on.
  useCard() {
    const {gl, data} = this;
    this.splatter = null;
    this.placed = [NaN, NaN];
    this.placer = new Placer(gl, data);
    this.buffers = [this.placer.makeBuffer(), this.placer.makeBuffer()];
    this.shader = makeProgram(gl, document.getElementById('draw-shader').textContent, kFragment);
    this.tables = data.head.colourings.map((one) => this.makeColours(one.colours));
    this.given = this.buffers.map(() => this.makeGiven());
    this.arrays = this.buffers.map((points, map) => this.makeArray(points, this.given[map].buffer));
  }

  // What colours a map's points where the program computed it.
  makeGiven() {
    const {gl, data} = this, one = {indices: new Uint8Array(data.count), buffer: gl.createBuffer(), of: ''};
    gl.bindBuffer(gl.ARRAY_BUFFER, one.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, one.indices, gl.DYNAMIC_DRAW);
    return one;
  }

  giveColours(map, colouring) {
    const {gl} = this, one = this.given[map], of = `${this.colouring} ${this.placed[map]}`;
    if (colouring.given.length === 0 || one.of === of) return;
    one.of = of;
    givenIndices(colouring, this.placed[map], one.indices);
    gl.bindBuffer(gl.ARRAY_BUFFER, one.buffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, one.indices);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
  }

  makeArray(points, given) {
    const {gl, shader, placer} = this, array = gl.createVertexArray();
    const use = (name, call) => {
      const at = gl.getAttribLocation(shader.program, name);
      if (at < 0) return;
      gl.enableVertexAttribArray(at);
      call(at);
    };
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, points);
    use('a_point_m', (at) => gl.vertexAttribPointer(at, 3, gl.FLOAT, false, Placer.kStride, 0));
    use('a_height_m', (at) => gl.vertexAttribPointer(at, 1, gl.FLOAT, false, Placer.kStride, 12));
    use('a_direction', (at) => gl.vertexAttribPointer(at, 1, gl.FLOAT, false, Placer.kStride, 16));
    gl.bindBuffer(gl.ARRAY_BUFFER, placer.words);
    use('a_tick', (at) => gl.vertexAttribIPointer(at, 1, gl.UNSIGNED_INT, 12, 8));
    gl.bindBuffer(gl.ARRAY_BUFFER, given);
    use('a_given', (at) => gl.vertexAttribPointer(at, 1, gl.UNSIGNED_BYTE, true, 1, 0));
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    return array;
  }

  makeColours(colours) {
    const {gl} = this, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
    return texture;
  }

  setOffset(map, offset_ms) {
    if (this.placed[map] === offset_ms) return;
    if (this.splatter) this.splatter.setOffset(map, offset_ms);
    else this.placer.place(offset_ms, this.buffers[map]);
    this.placed[map] = offset_ms;
  }

  // The points of a map as they were placed, 5 floats each.
  pointsOf(map) { return this.splatter ? this.splatter.maps[map].points : this.placer.read(this.buffers[map]); }

  // Where the maps are in the canvas, in CSS pixels: `view` is what the camera fills, `clip` what is drawn of it.
  panes() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, gap = 2;
    if (this.layout === 'swipe') {
      const at = Math.round(width * this.divider), view = {x: 0, y: 0, width, height};
      return [{view, clip: {x: 0, y: 0, width: at - gap / 2, height}},
              {view, clip: {x: at + gap / 2, y: 0, width: width - at - gap / 2, height}}];
    }
    const stacked = this.stacked();
    const part = stacked ? {width, height: (height - gap) / 2} : {width: (width - gap) / 2, height};
    return [0, 1].map((i) => {
      const view = {x: stacked ? 0 : i * (part.width + gap), y: stacked ? i * (part.height + gap) : 0, ...part};
      return {view, clip: view};
    });
  }

  stacked() { return this.canvas.clientWidth < 640; }

  isTop() { return this.camera.pitch > 89.99; }

  metresPerPx() { return this.camera.height / this.panes()[0].view.height; }

  // Shows the whole map from one of the named directions. From above the longer side lies along the pane's.
  fit(key) {
    const {width, height} = this.panes()[0].view, {head} = this.data;
    const box = key === 7 ? head.box_m.top : head.box_m.other;
    const heightOf = (view) => {
      const [right, up] = halfSeen(box, axesOf(view));
      return 2 * kRoom * Math.max(up, right * height / width, 1e-3);
    };
    let view = {...kViews[key]};
    const turned = {...view, yaw: 0};
    if (key === 7 && heightOf(turned) < 0.83 * heightOf(view)) view = turned;
    const middle = [0, 1, 2].map((i) => (box[0][i] + box[1][i]) / 2);
    this.camera = {middle, yaw: view.yaw, pitch: view.pitch, height: heightOf(view), fitted: key};
  }

  // From above, the place where the maps differ most.
  fitCloseUp() {
    const {centre_m, height_m} = this.data.head.close_up, {head} = this.data;
    this.fit(7);
    const {width, height} = this.panes()[0].view;
    this.camera.middle = [...centre_m, (head.box_m.top[0][2] + head.box_m.top[1][2]) / 2];
    this.camera.height = height_m * Math.max(1, height / width);
    this.camera.fitted = 'n';
  }

  orbit(dx, dy) {
    const {camera} = this;
    camera.yaw -= dx * 0.4;
    camera.pitch = Math.min(90, Math.max(-90, camera.pitch + dy * 0.4));
    camera.fitted = 0;
  }

  pan(dx, dy) {
    const axes = axesOf(this.camera), scale = this.metresPerPx();
    this.camera.middle =
        this.camera.middle.map((m, i) => m - scale * dx * axes.right[i] + scale * dy * axes.up[i]);
    this.camera.fitted = 0;
  }

  // The point of the canvas under the pointer stays where it is.
  zoom(factor, x, y) {
    const pane = this.paneAt(x, y).view;
    const dx = x - pane.x - pane.width / 2, dy = y - pane.y - pane.height / 2;
    const height = Math.min(1e4, Math.max(0.05, this.camera.height / factor));
    const real = this.camera.height / height;
    this.pan(dx * (1 / real - 1), dy * (1 / real - 1));
    this.camera.height = height;
  }

  paneAt(x, y) {
    const panes = this.panes();
    return panes.find(({clip}) => x < clip.x + clip.width && y < clip.y + clip.height) ?? panes[1];
  }

  resize() {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.ratio = ratio;
  }

  draw() {
    this.resize();
    if (this.splatter) this.drawInSoftware();
    else this.drawOnCard();
  }

  drawOnCard() {
    const {gl, shader} = this, one = this.data.head.colourings[this.colouring];
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0.19, 0.215, 0.255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(shader.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.tables[this.colouring]);
    gl.uniform1i(shader.at('u_table'), 0);
    gl.uniform1i(shader.at('u_colour_by'), one.given.length > 0 ? 3 : kComputed.indexOf(one.by));
    gl.uniform2f(shader.at('u_range'), one.from, one.to);
    gl.uniform1f(shader.at('u_tick_s'), this.data.head.tick_s);
    gl.uniform1f(shader.at('u_zero_s'), this.data.head.laser_origin_s - this.data.head.time_origin_s);
    this.setCamera();
    this.buffers.forEach((_, map) => this.giveColours(map, one));
    this.panes().forEach(({view, clip}, map) => this.drawMap(view, clip, this.arrays[map]));
    gl.bindVertexArray(null);
  }

  drawInSoftware() {
    const {splatter, camera, canvas} = this, pixels = (bytes) => new Uint32Array(new Uint8Array(bytes).buffer)[0];
    const colours = new Uint32Array(this.data.head.colourings[this.colouring].colours.buffer);
    splatter.begin(canvas.width, canvas.height, pixels([48, 55, 65, 255]));
    this.panes().forEach(({view, clip}, map) => {
      const [seen, drawn] = [view, clip].map((place) => this.inPixels(place));
      splatter.fill(drawn, pixels([9, 11, 14, 255]));
      splatter.colourise(splatter.maps[map], this.colouring);
      const scale = seen.height / camera.height;
      splatter.drawMap(map, seen, drawn, {axes: axesOf(camera), middle: camera.middle, scale}, this.slabs(),
                       Math.max(1, Math.round(this.pointSize())), colours);
    });
    splatter.end();
  }

  // A rectangle of CSS pixels in the canvas's own, rows from the bottom.
  inPixels({x, y, width, height}) {
    const [left, top, right, bottom] = [x, y, x + width, y + height].map((v) => Math.round(v * this.ratio));
    return {x: left, y: this.canvas.height - bottom, width: right - left, height: bottom - top};
  }

  slabs() {
    const {head} = this.data;
    const slabs = (this.isTop() ? head.slabs_m.top : head.slabs_m.other)
                      .map(([from, to]) => [from ?? -1e29, to ?? 1e29]);
    return [...slabs[0], ...(slabs[1] ?? slabs[0])];
  }

  pointSize() { return this.ratio * Math.min(4, Math.max(1.25, 0.02 / this.metresPerPx())); }

  setCamera() {
    const {gl, shader, camera} = this, axes = axesOf(camera), {head} = this.data;
    const {width, height} = this.panes()[0].view;
    const whole = Math.hypot(...[0, 1, 2].map((i) => head.box_m.other[1][i] - head.box_m.other[0][i]));
    gl.uniformMatrix3fv(shader.at('u_axes'), false, [...axes.right, ...axes.up, ...axes.back]);
    gl.uniform3fv(shader.at('u_middle_m'), camera.middle);
    gl.uniform3f(shader.at('u_half_m'), camera.height / 2 * width / height, camera.height / 2, 4 * whole + 100);
    gl.uniform4f(shader.at('u_slabs_m'), ...this.slabs());
    gl.uniform1f(shader.at('u_size_px'), this.pointSize());
  }

  drawMap(view, clip, array) {
    const {gl} = this, seen = this.inPixels(view), drawn = this.inPixels(clip);
    gl.viewport(seen.x, seen.y, seen.width, seen.height);
    gl.scissor(drawn.x, drawn.y, Math.max(0, drawn.width), drawn.height);
    gl.clearColor(9 / 255, 11 / 255, 14 / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.POINTS, 0, this.data.count);
  }
}

// Mouse, wheel, touch. One finger or the left button turns, two fingers or another button move; wheel and pinch zoom.
function listenToPointers(scene, changed) {
  const {canvas} = scene, pointers = new Map();
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top, moves: event.buttons > 1 || event.shiftKey};
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
  });
  for (const end of ['pointerup', 'pointercancel'])
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = at(event), others = [...pointers].filter(([id]) => id !== event.pointerId);
    pointers.set(event.pointerId, now);
    const dx = now.x - before.x, dy = now.y - before.y;
    if (others.length > 0) {
      const other = others[0][1], length = (p) => Math.hypot(p.x - other.x, p.y - other.y);
      scene.zoom(length(now) / Math.max(1, length(before)), (now.x + other.x) / 2, (now.y + other.y) / 2);
      scene.pan(dx / 2, dy / 2);
    } else if (now.moves) {
      scene.pan(dx, dy);
    } else {
      scene.orbit(dx, dy);
    }
    changed();
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const {x, y} = at(event), lines = event.deltaMode === 1 ? 30 : 1;
    scene.zoom(Math.exp(-event.deltaY * lines * 0.0015), x, y);
    changed();
  }, {passive: false});
  canvas.addEventListener('dblclick', (event) => {
    const {x, y} = at(event), pane = scene.paneAt(x, y).view;
    scene.pan(pane.x + pane.width / 2 - x, pane.y + pane.height / 2 - y);
    changed();
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
}
