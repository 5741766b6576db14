'use strict';
// A recording dropped onto the page goes to the program's disk.

/** Sends one file after it was announced, and shows how far it is. */
class Uploader {
  constructor(tell, place, say) {
    this.tell = tell;
    this.place = place;
    this.say = say;
    this.waiting = new Map();  // announced, by name
    window.addEventListener('dragover', (event) => event.preventDefault());
    window.addEventListener('dragenter', (event) => this.hovered(event, 1));
    window.addEventListener('dragleave', (event) => this.hovered(event, -1));
    window.addEventListener('drop', (event) => this.dropped(event));
    this.over = 0;
  }

  /** While files are held over the page: where they will go. Its parts are entered and left one by one. */
  hovered(event, change) {
    event.preventDefault();
    this.over = change === 0 ? 0 : Math.max(0, this.over + change);
    const sign = document.getElementById('drop');
    sign.hidden = this.over === 0;
    sign.textContent = 'Drop one recording: it is sent to the machine that runs sweepscope, and opened.';
  }

  dropped(event) {
    event.preventDefault();
    this.hovered(event, 0);
    const items = [...event.dataTransfer.items].filter((item) => item.kind === 'file');
    const folder = items.some((item) => item.webkitGetAsEntry && (item.webkitGetAsEntry() || {}).isDirectory);
    if (folder) return this.say('A folder cannot be dropped here. Copy it to the machine, and open it with Ctrl-O.');
    if (items.length > 1) return this.say('Drop one recording at a time.');
    if (items.length === 1) this.announce(items[0].getAsFile());
  }

  announce(file) {
    this.say('');
    this.waiting.set(file.name, file);
    this.tell({type: 'upload', name: file.name, size_bytes: file.size});
  }

  /** The program's answer: an address, or why not. */
  answered(message) {
    const file = this.waiting.get(message.name);
    this.waiting.delete(message.name);
    if (!file) return;
    if (message.refused) return this.say(message.refused);
    this.send(file, message.address.replace(/^\//, ''));
  }

  send(file, address) {
    const request = new XMLHttpRequest();
    const line = this.line(file.name, () => request.abort());
    const total_MB = file.size / 1e6;
    const over = (text) => {
      line.remove();
      this.say(text);
    };
    request.upload.onprogress = (event) =>
      line.show(event.loaded / Math.max(1, file.size), `${(event.loaded / 1e6).toFixed(1)} of ${total_MB.toFixed(1)} MB`);
    request.onload = () => {
      const answer = request.responseText.trim();
      if (request.status !== 200) over(answer || `${file.name} could not be sent.`);
      else over(answer === 'opened' ? '' : `${file.name} was sent. Open it with Ctrl-O.`);
    };
    request.onerror = () => over(`${file.name} was not sent: the connection broke, or the disk is full.`);
    request.onabort = () => over('');
    request.open('PUT', address);
    request.send(file);
  }

  line(name, cancel) {
    const line = document.createElement('div');
    line.className = 'file';
    const bar = document.createElement('progress'), text = document.createElement('span');
    const stop = document.createElement('button');
    text.textContent = `Sending ${name}`;
    bar.max = 1;
    bar.value = 0;
    stop.textContent = 'Cancel';
    stop.onclick = cancel;
    line.append(text, bar, stop);
    this.place.append(line);
    return {
      show: (fraction, amount) => {
        bar.value = fraction;
        text.textContent = `Sending ${name}: ${amount}`;
      },
      remove: () => line.remove(),
    };
  }
}
