'use strict';
// The criteria over the offset, with the handles A and B.

function svgElement(name, attributes, parent, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
}

function roundTicks(from, to, atMost) {
  const rough = (to - from) / atMost, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough * (1 - 1e-9));
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), ticks = [];
  for (let k = Math.ceil(from / step - 1e-9); k <= Math.floor(to / step + 1e-9); ++k)
    ticks.push({value: k * step, label: (k * step).toFixed(decimals).replace('-', '\u2212')});
  return ticks;
}

// One chart. `moved(handle, offset_ms)` is told of a handle that is dragged.
class CriterionChart {
  static kHeight = 210;
  static kEdge = {left: 52, right: 14, top: 44, bottom: 36};

  constructor(parent, chart, span, moved) {
    this.chart = chart;
    this.span = span;
    this.moved = moved;
    this.svg = svgElement('svg', {class: 'live-chart', role: 'img', 'aria-label': chart.title}, parent);
    this.handles = [];
    this.listen();
  }

  // The criterion's values within the span.
  range() {
    const {chart, span} = this, values = [];
    for (const one of chart.series) {
      one.y.forEach((y, i) => {
        if (y !== null && one.x[i] >= span[0] && one.x[i] <= span[1]) values.push(y);
      });
    }
    if (chart.with_zero || values.length === 0) values.push(0);
    const least = Math.min(...values), greatest = Math.max(...values), room = (greatest - least) * 0.08 || 1e-6;
    return [chart.with_zero && least === 0 ? 0 : least - room, greatest + room];
  }

  x(offset_ms) {
    const {left, right} = CriterionChart.kEdge, [from, to] = this.span;
    return left + (offset_ms - from) / (to - from) * (this.width - left - right);
  }

  offsetAt(x) {
    const {left, right} = CriterionChart.kEdge, [from, to] = this.span;
    return Math.min(to, Math.max(from, from + (x - left) / (this.width - left - right) * (to - from)));
  }

  y(value) {
    const {top, bottom} = CriterionChart.kEdge, [from, to] = this.shown;
    return CriterionChart.kHeight - bottom - (value - from) / (to - from) * (CriterionChart.kHeight - top - bottom);
  }

  draw(width) {
    this.width = width;
    this.shown = this.range();
    const {svg, chart} = this, height = CriterionChart.kHeight, edge = CriterionChart.kEdge;
    svg.replaceChildren();
    svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    svg.setAttribute('height', height);
    const title = svgElement('text', {x: 4, y: 14, class: 'chart-title'}, svg, chart.title);
    const length = title.getComputedTextLength();  // on a phone a long title is written smaller
    if (length > width - 8) title.style.fontSize = `${13 * (width - 8) / length}px`;
    this.drawAxes(height, edge);
    const clip = svgElement('svg', {x: edge.left, y: edge.top - 4, width: width - edge.left - edge.right,
                                    height: height - edge.top - edge.bottom + 8,
                                    viewBox: `${edge.left} ${edge.top - 4} ${width - edge.left - edge.right} ${
                                        height - edge.top - edge.bottom + 8}`}, svg);
    chart.series.forEach((one, i) => this.drawSeries(clip, one, i));
    for (const [x, y] of chart.markers) {
      const [px, py] = [this.x(x), this.y(y)];
      svgElement('path', {d: `M${px} ${py - 6}l6 6l-6 6l-6-6z`, class: 'chart-best'}, clip);
    }
    this.drawFound(height, edge);
    this.handles = ['a', 'b'].map((name) => this.makeHandle(name, height, edge));
  }

  drawAxes(height, edge) {
    const {svg, width} = this, bottom = height - edge.bottom;
    for (const tick of roundTicks(...this.shown, 5)) {
      const y = this.y(tick.value);
      svgElement('line', {x1: edge.left, x2: width - edge.right, y1: y, y2: y, class: 'chart-grid'}, svg);
      svgElement('text', {x: edge.left - 6, y: y + 4, class: 'chart-label', 'text-anchor': 'end'}, svg, tick.label);
    }
    for (const tick of roundTicks(...this.span, Math.max(2, Math.floor(width / 80)))) {
      const x = this.x(tick.value);
      svgElement('line', {x1: x, x2: x, y1: edge.top, y2: bottom, class: 'chart-grid'}, svg);
      svgElement('text', {x, y: bottom + 15, class: 'chart-label', 'text-anchor': 'middle'}, svg, tick.label);
    }
    svgElement('text', {x: (edge.left + width - edge.right) / 2, y: height - 4, class: 'chart-label',
                        'text-anchor': 'middle'}, svg, 'offset [ms]');
  }

  drawSeries(parent, one, index) {
    let path = '', gap = true;
    one.x.forEach((x, i) => {
      if (one.y[i] === null) {
        gap = true;
        return;
      }
      path += `${gap ? 'M' : 'L'}${this.x(x).toFixed(2)} ${this.y(one.y[i]).toFixed(2)}`;
      gap = false;
    });
    const look = one.dashed ? 'chart-fit' : index === 0 ? 'chart-curve' : 'chart-second';
    svgElement('path', {d: path, class: look}, parent);
    if (one.dashed) return;
    one.x.forEach((x, i) => {
      if (one.y[i] === null || x < this.span[0] || x > this.span[1]) return;
      svgElement('circle', {cx: this.x(x), cy: this.y(one.y[i]), r: 2.2, class: look + ' chart-dot'}, parent);
    });
  }

  drawFound(height, edge) {
    for (const line of this.chart.verticals) {
      const x = this.x(line.x);
      svgElement('line', {x1: x, x2: x, y1: edge.top, y2: height - edge.bottom, class: 'chart-found'}, this.svg);
    }
  }

  makeHandle(name, height, edge) {
    const group = svgElement('g', {class: 'handle handle-' + name}, this.svg);
    svgElement('line', {x1: 0, x2: 0, y1: edge.top - 4, y2: height - edge.bottom}, group);
    svgElement('rect', {x: -10, y: edge.top - 22, width: 20, height: 18, rx: 4}, group);
    svgElement('text', {x: 0, y: edge.top - 8, 'text-anchor': 'middle'}, group, name.toUpperCase());
    return group;
  }

  setOffsets(offsets_ms) {
    offsets_ms.forEach((offset_ms, i) => {
      this.handles[i].setAttribute('transform', `translate(${this.x(offset_ms).toFixed(2)} 0)`);
    });
    this.offsets = offsets_ms;
  }

  // The nearer handle is dragged from wherever the chart was touched; vertical swipes still scroll the page.
  listen() {
    let held = -1;
    const place = (event) => {
      const box = this.svg.getBoundingClientRect();
      return (event.clientX - box.left) * this.width / box.width;
    };
    this.svg.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      const x = place(event), far = this.offsets.map((offset_ms) => Math.abs(this.x(offset_ms) - x));
      held = far[0] < far[1] ? 0 : 1;
      this.svg.setPointerCapture(event.pointerId);
      this.moved(held, this.offsetAt(x));
    });
    this.svg.addEventListener('pointermove', (event) => {
      if (held >= 0) this.moved(held, this.offsetAt(place(event)));
    });
    for (const end of ['pointerup', 'pointercancel']) this.svg.addEventListener(end, () => { held = -1; });
  }
}
