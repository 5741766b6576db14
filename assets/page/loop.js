'use strict';
// Places the beams at an offset in a loop of this script, as place.vert does on a graphics card: where WebGL is
// software, this is faster (tests/benchmark/page).

class LoopPlacer {
  constructor(data) {
    this.data = data;
    this.motor = motorTables(data);
    this.motorFloats = new Float32Array(this.motor.samples.buffer);
    this.path = pathTables(data);
  }

  // Of each beam x, y, z (map frame), height above the sensor's path (1e30: not placed), and direction: 5 floats.
  place(offset_ms, points) {
    const {head, counts} = this.data, scans = scanPoses(this.data, offset_ms);
    const shift = Math.round((head.laser_origin_s - head.motor_origin_s + offset_ms * 1e-3) / head.tick_s);
    for (let scan = 0, begin = 0; scan < counts.length; begin += counts[scan++]) {
      const end = begin + counts[scan], pose = scans[4 * scan];
      if (pose === 0) {
        this.leaveOut(begin, end, points);
        continue;
      }
      this.turn(begin, end, shift, scans[4 * scan + 1], points);
      if (head.moving) this.move(begin, end, 4 * (pose - 1), points);
    }
  }

  leaveOut(begin, end, points) {
    points.fill(0, 5 * begin, 5 * end);
    for (let i = begin; i < end; ++i) points[5 * i + 3] = 1e30;
  }

  // By the motor's angle at each beam's own time, into the base frame.
  turn(begin, end, shift, direction, points) {
    const {words, head} = this.data, {samples, first, bits, count} = this.motor, floats = this.motorFloats;
    const [x0, y0, z0] = head.corner_m, [ax, ay, az] = head.axis, step = head.step_m;
    let at = -1;
    for (let i = begin; i < end; ++i) {
      const low = words[3 * i], high = words[3 * i + 1], tick = words[3 * i + 2] + shift;
      if (at < 0) at = first[Math.max(0, tick >> bits)];
      while (at + 2 < count && samples[4 * at + 4] <= tick) ++at;
      const part = (tick - samples[4 * at]) / (samples[4 * at + 4] - samples[4 * at]);
      const rest = Math.min(1, Math.max(0, part)) * floats[4 * at + 3], sine0 = floats[4 * at + 1], cosine0 = floats[4 * at + 2];
      const sine = sine0 * Math.cos(rest) + cosine0 * Math.sin(rest), cosine = cosine0 * Math.cos(rest) - sine0 * Math.sin(rest);
      const x = x0 + step * (low & 0x1fffff), y = y0 + step * (low >>> 21 | (high & 0x3ff) << 11), z = z0 + step * (high >>> 10);
      const along = (1 - cosine) * (ax * x + ay * y + az * z);
      points[5 * i] = cosine * x + sine * (ay * z - az * y) + along * ax;
      points[5 * i + 1] = cosine * y + sine * (az * x - ax * z) + along * ay;
      points[5 * i + 2] = cosine * z + sine * (ax * y - ay * x) + along * az;
      points[5 * i + 3] = points[5 * i + 2];
      points[5 * i + 4] = direction;
    }
  }

  // By the pose, into the map frame: see motion() of place.vert.
  move(begin, end, pose, points) {
    const {words} = this.data, {poses, steps} = this.path;
    const begun = poses[pose] | 0, each = poses[pose + 3] / poses[pose + 1];
    for (let i = begin; i < end; ++i) {
      const along = ((words[3 * i + 2] | 0) - begun) * each;
      const step = Math.min(poses[pose + 3] - 1, Math.max(0, Math.trunc(along))), u = along - step;
      const s = 16 * (poses[pose + 2] + step), tx = steps[s + 8], ty = steps[s + 9], tz = steps[s + 10];
      const a2 = u * u * (tx * tx + ty * ty + tz * tz);
      const one = u * (1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72))));
      const two = u * u * (0.5 - a2 / 24 * (1 - a2 / 30 * (1 - a2 / 56)));
      const x = points[5 * i], y = points[5 * i + 1], z = points[5 * i + 2];
      const cx = ty * z - tz * y, cy = tz * x - tx * z, cz = tx * y - ty * x;
      const px = x + one * cx + two * (ty * cz - tz * cy), py = y + one * cy + two * (tz * cx - tx * cz);
      const pz = z + one * cz + two * (tx * cy - ty * cx);
      const qx = steps[s], qy = steps[s + 1], qz = steps[s + 2], qw = steps[s + 3];
      const wx = qy * pz - qz * py + qw * px, wy = qz * px - qx * pz + qw * py, wz = qx * py - qy * px + qw * pz;
      const rig = steps[s + 6] + u * steps[s + 12];
      points[5 * i] = px + 2 * (qy * wz - qz * wy) + steps[s + 4] + u * steps[s + 7];
      points[5 * i + 1] = py + 2 * (qz * wx - qx * wz) + steps[s + 5] + u * steps[s + 11];
      points[5 * i + 2] = pz + 2 * (qx * wy - qy * wx) + rig;
      points[5 * i + 3] = points[5 * i + 2] - rig;
    }
  }
}
