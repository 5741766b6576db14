'use strict';
// Fingers: one is the left button, two zoom and move the view, one that rests opens the list of commands.

const LONG_MS = 550, SLOP_PX = 9;

class Touch {
  constructor(canvas, keys, sender) {
    this.canvas = canvas;
    this.keys = keys;
    this.sender = sender;
    this.fingers = new Map();
    this.long_ms = LONG_MS;
    this.state = 'none';  // none, waiting (for what one finger does), drag, pinch, over
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.moved(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointercancel', (event) => this.up(event, true));
  }

  down(event) {
    if (event.pointerType !== 'touch') return;
    event.preventDefault();
    this.canvas.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, this.keys.at(event));
    if (this.fingers.size === 1) {
      this.state = 'waiting';
      this.from = this.keys.at(event);
      this.slop = SLOP_PX * this.canvas.width / this.canvas.getBoundingClientRect().width;
      this.timer = setTimeout(() => this.rested(), this.long_ms);
    } else if (this.fingers.size === 2) {
      this.beginPinch();
    }
  }

  moved(event) {
    if (!this.fingers.has(event.pointerId)) return;
    this.fingers.set(event.pointerId, this.keys.at(event));
    if (this.state === 'pinch') return this.pinch();
    const [x, y] = this.keys.at(event);
    if (this.state === 'waiting' && Math.hypot(x - this.from[0], y - this.from[1]) > this.slop) this.beginDrag();
    if (this.state === 'drag') this.sender.moved(x, y);
  }

  up(event, cancelled = false) {
    if (!this.fingers.delete(event.pointerId)) return;
    clearTimeout(this.timer);
    if (this.state === 'waiting' && !cancelled) this.tap();
    if (this.state === 'drag' && !cancelled) this.sender.move = ['move', ...this.keys.at(event)];  // where it was lifted
    if (this.state === 'drag') this.sender.flush([['press', 0, false, 0]]);
    if (this.state === 'pinch') this.sender.flush([['press', 1, false, 0]]);
    this.state = this.fingers.size > 0 ? 'over' : 'none';
  }

  tap() {
    // A finger that left hovers over nothing.
    this.sender.flush([['move', ...this.from], ['press', 0, true, 0], ['press', 0, false, 0], ['move', -9, -9]]);
  }

  beginDrag() {
    clearTimeout(this.timer);
    this.state = 'drag';
    this.sender.flush([['move', ...this.from], ['press', 0, true, 0]]);
  }

  rested() {
    if (this.state !== 'waiting') return;
    this.state = 'over';
    this.sender.stroke('P', 2);
  }

  span() {
    const [a, b] = [...this.fingers.values()];
    return {x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, apart: Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]))};
  }

  beginPinch() {
    clearTimeout(this.timer);
    if (this.state === 'drag') this.sender.flush([['press', 0, false, 0]]);
    this.state = 'pinch';
    const {x, y, apart} = this.span();
    this.apart = apart;
    this.sender.flush([['move', x, y], ['press', 1, true, 0]]);
  }

  pinch() {
    const {x, y, apart} = this.span();
    // A click of the wheel is a factor of 1.15.
    const clicks = Math.log(apart / this.apart) / Math.log(1.15);
    if (Math.abs(clicks) < 0.05) return this.sender.moved(x, y);
    this.apart = apart;
    this.sender.flush([['move', x, y], ['wheel', Math.max(-20, Math.min(20, clicks))]]);
  }
}
