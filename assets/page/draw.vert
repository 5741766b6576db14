#version 300 es
// Draws a placed point: an orthographic camera, and the colour that the program gives to its value.
precision highp float;
precision highp int;
precision highp sampler2D;

in vec3 a_point_m;
in float a_height_m, a_direction, a_given;
in uint a_tick;

uniform mat3 u_axes;     // of the camera in the map frame: right, up, back
uniform vec3 u_middle_m;
uniform vec3 u_half_m;   // of what is seen to either side
uniform vec4 u_slabs_m;  // two ranges of heights above the sensor's path
uniform float u_size_px, u_tick_s, u_zero_s;  // u_zero_s: of the laser's ticks in the time that colours
uniform int u_colour_by;  // 0 elevation, 1 direction, 2 time, 3 a_given, a place in the table
uniform vec2 u_range;
uniform sampler2D u_table;  // 256 colours

flat out vec4 v_colour;

float value() {
  if (u_colour_by == 1) return a_direction;
  if (u_colour_by == 2) return float(a_tick) * u_tick_s + u_zero_s;
  return a_point_m.z;
}

void main() {
  vec3 seen = (a_point_m - u_middle_m) * u_axes / u_half_m;
  bool shown = (a_height_m >= u_slabs_m.x && a_height_m <= u_slabs_m.y) ||
               (a_height_m >= u_slabs_m.z && a_height_m <= u_slabs_m.w);
  gl_Position = shown ? vec4(seen.xy, -seen.z, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = u_size_px;
  float part = u_colour_by == 3 ? a_given : clamp((value() - u_range.x) / (u_range.y - u_range.x), 0.0, 1.0);
  v_colour = texelFetch(u_table, ivec2(int(255.0 * part + 0.5), 0), 0);
}
