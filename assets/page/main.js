'use strict';
// The live map: what is on the page, what keys and controls do, and what other scripts can ask for.

function htmlElement(name, attributes, parent, text) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

class LivePage {
  static kNames = ['A', 'B'];

  constructor(section) {
    this.section = section;
    this.data = readBeams();
    this.offset_ms = [...this.data.head.offset_ms];
    this.canvas = document.getElementById('live-canvas');
    section.hidden = false;  // a canvas that is not laid out has no size
    this.scene = new Scene(this.canvas, this.data);
    if (this.canvas.clientWidth < 640) this.scene.layout = 'swipe';
    this.makeBar();
    this.makeStage();
    this.makeCharts();
    this.scene.fit(7);
    this.drawNow();
    document.documentElement.classList.add('live');
    this.listen();
  }

  makeBar() {
    const bar = document.getElementById('live-bar'), {head} = this.data;
    const group = (label) => htmlElement('div', {class: 'live-group', role: 'group', 'aria-label': label}, bar);
    const views = group('View');
    this.viewButtons = {};
    for (const [key, {name}] of Object.entries(kViews)) {
      const button = htmlElement('button', {type: 'button', title: `key ${key}`}, views, name);
      button.addEventListener('click', () => this.view(Number(key)));
      this.viewButtons[key] = button;
    }
    const close = htmlElement('button', {type: 'button', title: 'key N'}, views, 'Where they differ');
    close.addEventListener('click', () => this.view('n'));
    this.viewButtons.n = close;
    const layouts = group('Layout');
    this.layoutButtons = {};
    for (const [layout, name, key] of [['side', 'Side by side', 'B'], ['swipe', 'Swipe', 'S']]) {
      const button = htmlElement('button', {type: 'button', title: `key ${key}`}, layouts, name);
      button.addEventListener('click', () => this.setLayout(layout));
      this.layoutButtons[layout] = button;
    }
    const label = htmlElement('label', {class: 'live-group'}, bar, 'Colour ');
    this.colours = htmlElement('select', {}, label);
    head.colourings.forEach((one, i) => htmlElement('option', {value: i}, this.colours, one.by));
    this.colours.addEventListener('change', () => {
      this.scene.colouring = Number(this.colours.value);
      this.changed();
    });
    const help = htmlElement('p', {class: 'live-help'}, document.getElementById('live-legend'),
                             'Drag turns; two fingers or the right button move; wheel or pinch zooms.');
    const keys = htmlElement('span', {class: 'live-keys'}, help);
    for (const [names, what] of [['1 3 7 9 0', 'views'], ['N', 'where they differ'], ['B S', 'layout'], [', .', 'offset A'],
                                 ['K L', 'offset B']]) {
      keys.append(' ');
      for (const name of names.split(' ')) htmlElement('kbd', {}, keys, name);
      keys.append(` ${what}`);
    }
  }

  makeStage() {
    const stage = document.getElementById('live-stage');
    this.labels = LivePage.kNames.map((name, i) => {
      const label = htmlElement('div', {class: 'live-label live-label-' + name.toLowerCase()}, stage);
      htmlElement('b', {}, label, name);
      label.append(' ');
      const given = this.section.dataset['label' + name];
      this.numbers = this.numbers ?? [];
      this.numbers[i] = htmlElement('span', {}, label);
      if (given) htmlElement('span', {class: 'live-given'}, label, ' ' + given);
      return label;
    });
    this.scale = htmlElement('div', {class: 'live-scale'}, stage);
    this.scaleText = htmlElement('span', {}, this.scale);
    this.divider = htmlElement('div', {class: 'live-divider', role: 'slider', tabindex: '0',
                                       'aria-label': 'Divider between A and B', 'aria-valuemin': '0',
                                       'aria-valuemax': '100'}, stage);
    const move = (event) => {
      const box = this.canvas.getBoundingClientRect();
      this.setDivider((event.clientX - box.left) / box.width);
    };
    this.divider.addEventListener('pointerdown', (event) => this.divider.setPointerCapture(event.pointerId));
    this.divider.addEventListener('pointermove', (event) => {
      if (event.buttons) move(event);
    });
    this.divider.addEventListener('keydown', (event) => {
      const step = {ArrowLeft: -0.02, ArrowRight: 0.02}[event.key];
      if (step) this.setDivider(this.scene.divider + step);
    });
    const legend = document.getElementById('live-legend');
    this.legend = htmlElement('div', {class: 'live-colours'});
    legend.prepend(this.legend);
    listenToPointers(this.scene, () => this.changed());
  }

  makeCharts() {
    const parent = document.getElementById('live-charts'), {head} = this.data;
    const sliders = htmlElement('div', {class: 'live-sliders'});
    this.sliders = LivePage.kNames.map((name, i) => {
      const label = htmlElement('label', {class: 'live-slider live-slider-' + name.toLowerCase()}, sliders);
      htmlElement('b', {}, label, name);
      const slider = htmlElement('input', {type: 'range', min: head.span_ms[0], max: head.span_ms[1], step: 0.01,
                                           'aria-label': `Offset of map ${name} in ms`}, label);
      slider.addEventListener('input', () => this.setOffset(i, Number(slider.value)));
      const number = htmlElement('output', {}, label);
      return {slider, number};
    });
    parent.before(sliders);
    this.charts = head.charts.map((chart) => new CriterionChart(parent, chart, head.span_ms,
                                                                 (i, offset_ms) => this.setOffset(i, offset_ms)));
    this.layCharts();
  }

  layCharts() {
    for (const chart of this.charts) {
      chart.draw(Math.max(240, chart.svg.clientWidth || chart.svg.parentElement.clientWidth));
      chart.setOffsets(this.offset_ms);
    }
  }

  listen() {
    this.canvas.addEventListener('webglcontextlost', () => this.stop());
    document.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => {
      this.refit();
      this.layCharts();
      this.changed();
    }).observe(document.getElementById('live-stage'));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    const step = event.shiftKey ? 1 : 0.1, key = event.key.toLowerCase();
    const steps = {',': [0, -step], '<': [0, -1], '.': [0, step], '>': [0, 1], k: [1, -step], l: [1, step]};
    if (kViews[key]) this.view(Number(key));
    else if (key === 'n') this.view('n');
    else if (key === '0') this.view(this.scene.isTop() ? 7 : 9);
    else if (key === 'b') this.setLayout('side');
    else if (key === 's') this.setLayout('swipe');
    else if (steps[key]) this.setOffset(steps[key][0], this.offset_ms[steps[key][0]] + steps[key][1]);
    else return;
    event.preventDefault();
  }

  view(key) {
    if (key === 'n') this.scene.fitCloseUp();
    else this.scene.fit(key);
    this.changed();
  }

  // A view that nobody moved fits again when its pane changes.
  refit() {
    if (this.scene.camera.fitted) this.view(this.scene.camera.fitted);
  }

  setLayout(layout) {
    this.scene.layout = layout;
    this.refit();
    this.changed();
  }

  setDivider(part) {
    this.scene.divider = Math.min(0.98, Math.max(0.02, part));
    this.changed();
  }

  setOffset(map, offset_ms) {
    const [from, to] = this.data.head.span_ms;
    this.offset_ms[map] = Math.round(Math.min(to, Math.max(from, offset_ms)) * 100) / 100;
    this.changed();
  }

  changed() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.drawNow();
    });
  }

  drawNow() {
    this.offset_ms.forEach((offset_ms, map) => this.scene.setOffset(map, offset_ms));
    this.scene.draw();
    this.showState();
  }

  showState() {
    const {scene} = this, text = (ms) => ms.toFixed(2).replace('-', '\u2212') + '\u00a0ms';
    this.offset_ms.forEach((offset_ms, i) => {
      this.numbers[i].textContent = text(offset_ms);
      this.sliders[i].number.textContent = text(offset_ms);
      this.sliders[i].slider.value = offset_ms;
    });
    for (const chart of this.charts) chart.setOffsets(this.offset_ms);
    for (const [key, button] of Object.entries(this.viewButtons))
      button.setAttribute('aria-pressed', String(scene.camera.fitted) === key);
    for (const [layout, button] of Object.entries(this.layoutButtons))
      button.setAttribute('aria-pressed', scene.layout === layout);
    this.showLabels();
    this.showScale();
    this.showLegend();
  }

  showLabels() {
    const {scene} = this, panes = scene.panes(), swipe = scene.layout === 'swipe', width = this.canvas.clientWidth;
    this.labels.forEach((label, i) => {
      const right = i === 1 && (swipe || !scene.stacked());
      label.style.top = `${panes[i].clip.y + 8}px`;
      label.style.left = right && !swipe ? `${panes[1].clip.x + 8}px` : right ? 'auto' : '8px';
      label.style.right = right && swipe ? '8px' : 'auto';
    });
    this.divider.hidden = !swipe;
    this.divider.style.left = `${width * scene.divider}px`;
    this.divider.setAttribute('aria-valuenow', Math.round(100 * scene.divider));
  }

  showScale() {
    const metres = 120 * this.scene.metresPerPx(), power = 10 ** Math.floor(Math.log10(metres));
    const length = [5, 2, 1].map((f) => f * power).find((l) => l <= metres);
    this.scale.style.width = `${length / this.scene.metresPerPx()}px`;
    this.scaleText.textContent = length >= 1 ? `${length.toFixed(0)} m` : `${(100 * length).toFixed(0)} cm`;
  }

  showLegend() {
    if (this.legend.dataset.colouring === String(this.scene.colouring)) return;
    this.legend.dataset.colouring = this.scene.colouring;
    const one = this.data.head.colourings[this.scene.colouring], bytes = one.colours;
    const colour = (i) => `rgb(${bytes[4 * i]}, ${bytes[4 * i + 1]}, ${bytes[4 * i + 2]})`;
    this.legend.replaceChildren();
    if (one.classes.length > 0) {
      one.classes.forEach(({name, colour: [red, green, blue]}) => {
        const chip = htmlElement('span', {class: 'live-chip'}, this.legend);
        chip.style.background = `rgb(${red}, ${green}, ${blue})`;
        htmlElement('span', {}, this.legend, `${one.title} ${name}`);
      });
      return;
    }
    const number = (value) => value.toFixed(1).replace('-', '\u2212') + (one.unit ? `\u00a0${one.unit}` : '');
    htmlElement('span', {}, this.legend, `${one.title} ${number(one.from)}`);
    const bar = htmlElement('span', {class: 'live-colour-bar'}, this.legend);
    // Place 0 of a table may be for what has no value.
    const stops = Array.from({length: 17}, (_, i) => colour(Math.max(1, Math.round(i * 255 / 16))));
    bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    htmlElement('span', {}, this.legend, number(one.to));
    if (one.given.length < 2) return;
    const offsets = one.given.map((level) => level.offset_ms.toFixed(2).replace('-', '\u2212')).join(', ');
    htmlElement('span', {class: 'live-measured'}, this.legend, `measured at ${offsets}\u00a0ms, in proportion between them`);
  }

  // Back to the pictures that stand still.
  stop() {
    document.documentElement.classList.remove('live');
    this.section.hidden = true;
  }

  // The points as they were placed: of each beam x, y, z (m, map frame), its time (s, laser clock), and the height
  // above the sensor's path (1e30: not placed at this offset).
  pointsAt(offset_ms) {
    const {scene, data} = this;
    scene.setOffset(1, offset_ms);
    const placed = scene.pointsOf(1), points = [];
    for (let i = 0; i < data.count; ++i) {
      const time_s = data.head.laser_origin_s + data.words[3 * i + 2] * data.head.tick_s;
      points.push([placed[5 * i], placed[5 * i + 1], placed[5 * i + 2], time_s, placed[5 * i + 3]]);
    }
    this.changed();
    return points;
  }

  // The colour of each point at an offset, where a loop draws them: red, green, blue.
  coloursAt(offset_ms, colouring) {
    const {scene, data} = this, {colours} = data.head.colourings[colouring];
    scene.setOffset(1, offset_ms);
    scene.splatter.colourise(scene.splatter.maps[1], colouring);
    this.changed();
    return Array.from(scene.splatter.maps[1].indices, (i) => [...colours.subarray(4 * i, 4 * i + 3)]);
  }
}

try {
  window.sweepscope = new LivePage(document.getElementById('live'));
} catch (error) {
  document.getElementById('live').hidden = true;
  document.documentElement.classList.remove('live');
  console.info(`The pictures stand still: ${error.message}`);
}
