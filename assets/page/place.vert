#version 300 es
// Places one beam at an offset, as core/map/beam_placer.cpp does: the motor turns it by the angle at its own time
// plus the offset, and the pose of its scan's sweep takes it into the map frame. Times are whole ticks, so that no
// digit of a long recording is lost; angles are small parts of a motor sample, so that the card's sine does not count.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;

in uvec2 a_place;  // 21 bits each of x, y and z, in the frame that turns with the motor
in uint a_tick;    // laser clock
in uint a_scan;

uniform vec3 u_corner_m, u_axis;
uniform float u_step_m;
uniform int u_shift;         // ticks from the laser's clock to the motor's, at the offset
uniform usampler2D u_motor;  // of each sample: tick; sine and cosine of the angle, and the turn to the next (float bits)
uniform usampler2D u_first;  // of each run of 2^u_run_bits ticks: the last sample at or before its begin
uniform int u_run_bits, u_samples;
uniform usampler2D u_scans;  // of each scan: number of its pose from 1, or 0; 1 where its sweep is odd
uniform usampler2D u_poses;  // of each pose: begin (tick, signed), duration in ticks, first step, number of steps
uniform sampler2D u_steps;   // of each step, four texels: see motion()
uniform bool u_moving;

out vec3 v_point_m;    // map frame
out float v_height_m;  // above the sensor's path; 1e30: not placed
out float v_direction;

const int kWidth = 1024;

ivec2 texel(int i) { return ivec2(i % kWidth, i / kWidth); }

// Sine and cosine of the motor's angle.
vec2 motor_at(int tick) {
  int i = int(texelFetch(u_first, texel(tick >> u_run_bits), 0).x);
  uvec4 here = texelFetch(u_motor, texel(i), 0), next = texelFetch(u_motor, texel(i + 1), 0);
  while (i + 2 < u_samples && int(next.x) <= tick) {
    ++i;
    here = next;
    next = texelFetch(u_motor, texel(i + 1), 0);
  }
  float part = clamp(float(tick - int(here.x)) / float(int(next.x) - int(here.x)), 0.0, 1.0);
  float a = part * uintBitsToFloat(here.w), a2 = a * a;
  float sine = a * (1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0 * (1.0 - a2 / 110.0)))));
  float cosine = 1.0 - a2 / 2.0 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0 * (1.0 - a2 / 90.0 * (1.0 - a2 / 132.0)))));
  float sine0 = uintBitsToFloat(here.y), cosine0 = uintBitsToFloat(here.z);
  return vec2(sine0 * cosine + cosine0 * sine, cosine0 * cosine - sine0 * sine);
}

// Into the map frame, with the height of the rig itself: rotation and translation at the step's begin, and the
// rotation vector and shift to its end; linear translation, rotation at constant rate.
vec4 motion(uvec4 pose, vec3 p) {
  int steps = int(pose.w);
  float along = float(int(a_tick) - int(pose.x)) / float(pose.y) * float(steps);
  int i = clamp(int(along), 0, steps - 1);
  float u = along - float(i);
  int first = 4 * (int(pose.z) + i);
  vec4 q = texelFetch(u_steps, texel(first), 0), begin = texelFetch(u_steps, texel(first + 1), 0);
  vec4 turn = texelFetch(u_steps, texel(first + 2), 0), rest = texelFetch(u_steps, texel(first + 3), 0);
  vec3 shift = vec3(begin.w, turn.w, rest.x);
  float a2 = u * u * dot(turn.xyz, turn.xyz);
  float sine = 1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0)));
  float cosine = 0.5 - a2 / 24.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0));
  vec3 across = cross(turn.xyz, p);
  vec3 turned = p + sine * u * across + cosine * u * u * cross(turn.xyz, across);
  vec3 rotated = turned + 2.0 * cross(q.xyz, cross(q.xyz, turned) + q.w * turned);
  vec3 rig = begin.xyz + u * shift;
  return vec4(rotated + rig, rig.z);
}

void main() {
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  uvec4 scan = texelFetch(u_scans, texel(int(a_scan)), 0);
  v_direction = float(scan.y);
  if (scan.x == 0u) {
    v_point_m = vec3(0.0);
    v_height_m = 1e30;
    return;
  }
  uvec3 place = uvec3(a_place.x & 0x1fffffu, a_place.x >> 21 | (a_place.y & 0x3ffu) << 11, a_place.y >> 10);
  vec3 p = u_corner_m + u_step_m * vec3(place);
  vec2 angle = motor_at(int(a_tick) + u_shift);
  p = angle.y * p + angle.x * cross(u_axis, p) + (1.0 - angle.y) * dot(u_axis, p) * u_axis;
  vec4 placed = vec4(p, 0.0);
  if (u_moving) placed = motion(texelFetch(u_poses, texel(int(scan.x) - 1), 0), p);
  v_point_m = placed.xyz;
  v_height_m = placed.z - placed.w;
}
