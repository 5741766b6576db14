"""The explorer that `sweepscope view --serve` shows in a headless Chromium."""
import base64
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "page"))
import chromium  # noqa: E402

MAX_STEP = 8  # of 255, between pixels that count as equal; as in the screenshot tests
RESTS = "(s) => s.connected && s.frame && s.frame.exact && s.frame.atRest"
CTRL, SHIFT = 2, 8  # of DevTools


class Viewer(chromium.Page):
    """A page with the explorer."""

    def until(self, condition):
        return self.value(f"sweepscope.until({condition})")

    def processed(self):
        """Everything that was sent is in the picture."""
        self.until("(s) => s.frame && s.frame.input >= sweepscope.sender.flush([])")

    def rest(self):
        self.processed()
        self.until(RESTS)

    def key(self, key, text="", modifiers=0, code=""):
        common = {"key": key, "code": code or (f"Key{key.upper()}" if len(key) == 1 else key), "modifiers": modifiers}
        self.send("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", text=text, **common)
        self.send("Input.dispatchKeyEvent", type="keyUp", **common)

    def type(self, text):
        for character in text:
            self.key(character, character, code="Space" if character == " " else "")

    def mouse(self, kind, x, y, buttons=0):
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left" if kind != "mouseMoved" else "none",
                  buttons=buttons, clickCount=1)

    def drag(self, from_x, to_x, y):
        self.mouse("mouseMoved", from_x, y)
        self.mouse("mousePressed", from_x, y, 1)
        for step in range(1, 11):
            self.mouse("mouseMoved", round(from_x + (to_x - from_x) * step / 10), y, 1)
            self.processed()
        self.mouse("mouseReleased", to_x, y)

    def copied(self, modifiers):
        """What Ctrl-C or Ctrl-Shift-C copies."""
        self.value("sweepscope.status.copied = ''")
        self.key("C" if modifiers & SHIFT else "c", modifiers=modifiers)
        self.until("(s) => s.copied !== ''")
        text = self.value("sweepscope.status.copied")
        self.key("Escape")  # the message of it
        self.rest()
        return text

    def columns(self):
        """The columns of the handles of A and B: of their colours in the lower part of the picture."""
        return self.value("""(() => {
          const c = sweepscope.canvas, top = Math.round(0.72 * c.height), height = c.height - top - 40;
          const p = c.getContext('2d').getImageData(0, top, c.width, height).data, found = [];
          for (const like of [(r, g, b) => r > 180 && g > 90 && g < 190 && b < 110,
                              (r, g, b) => r < 120 && g > 110 && b > 180]) {
            let best = -1, most = 0;
            for (let x = 0; x < c.width; ++x) {
              let n = 0;
              for (let y = 0; y < height; ++y) { const i = 4 * (y * c.width + x); n += like(p[i], p[i + 1], p[i + 2]) ? 1 : 0; }
              if (n > most) { most = n; best = x; }
            }
            found.push(best, most);
          }
          return found; })()""")

    def grip_row(self, x):
        """The lowest row of this column with the colour of A: the handle's foot."""
        return self.value("""((x) => {
          const c = sweepscope.canvas, p = c.getContext('2d').getImageData(x, 0, 1, c.height).data;
          for (let y = c.height - 1; y > 0; --y)
            if (p[4 * y] > 180 && p[4 * y + 1] > 90 && p[4 * y + 1] < 190 && p[4 * y + 2] < 110) return y;
          return -1; })(%d)""" % x)

    def differing(self, path):
        """The fraction of pixels that differ from a picture in a file; 1 where the size is another."""
        with open(path, "rb") as file:
            data = base64.b64encode(file.read()).decode()
        return self.value("""new Promise((done) => {
          const image = new Image();
          image.onload = () => {
            const c = sweepscope.canvas, other = document.createElement('canvas');
            if (image.width !== c.width || image.height !== c.height) return done(1);
            other.width = c.width; other.height = c.height;
            const drawn = other.getContext('2d', {alpha: false});
            drawn.drawImage(image, 0, 0);
            const a = drawn.getImageData(0, 0, c.width, c.height).data;
            const b = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            let n = 0;
            for (let i = 0; i < a.length; i += 4)
              n += Math.max(Math.abs(a[i] - b[i]), Math.abs(a[i + 1] - b[i + 1]), Math.abs(a[i + 2] - b[i + 2])) > %d ? 1 : 0;
            done(n / (c.width * c.height));
          };
          image.src = 'data:image/png;base64,%s'; })""" % (MAX_STEP, data))


def begin(program, folder, *more, address="127.0.0.1:0", estimates=False):
    """The server, whose files are those of FOLDER/files, and the address that it prints."""
    environment = {**os.environ, "HOME": folder, "XDG_STATE_HOME": folder + "/state"}
    environment.pop("DISPLAY", None)
    server = subprocess.Popen([program, "view", *([] if estimates else ["--no-estimate"]), *more, "--serve", address, "--root", folder + "/files"],
                              stdout=subprocess.PIPE, text=True, env=environment)
    for line in server.stdout:
        if found := re.search(r"http://\S+", line):
            return server, found.group(0)
    raise RuntimeError("no address was printed")
