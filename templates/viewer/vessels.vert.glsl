// Places a box about a cylinder with round ends, one pixel wider than the cylinder. The x axis of the box's coordinates
// runs from the cylinder's start to its end.
precision highp float;
precision highp int;

in vec3 position; // of a corner, each coordinate -1 or 1
in vec3 start, end;
in vec3 sizes; // radius; path lengths from the root to start and end, as fractions of the longest
in vec4 color; // sRGB

uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 eye, gaze;
uniform bool parallel;
uniform float pixel; // width of a pixel: mm in parallel projection, else mm per mm of distance
uniform float grown; // the fraction of the longest path that is shown
uniform int picked;

flat out mat3 axes;
flat out vec3 from;
flat out vec2 size; // length and radius
flat out vec3 pigment;
flat out float isPicked;
flat out int number;
out vec3 at, ray;

vec3 decoded(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

void main() {
  vec3 along = end - start;
  float whole = length(along), part = clamp((grown - sizes.y) / max(sizes.z - sizes.y, 1e-9), 0.0, 1.0);
  vec3 u = along / whole;
  vec3 v = normalize(cross(u, abs(u.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
  axes = mat3(u, v, cross(u, v));
  from = start;
  pigment = decoded(color.rgb);
  number = gl_InstanceID;
  isPicked = gl_InstanceID == picked ? 1.0 : 0.0;
  float reach = distance(eye, 0.5 * (start + end)) + whole;
  float one = pixel * (parallel ? 1.0 : reach); // width of a pixel at the segment, mm
  size = vec2(whole * part, max(sizes.x, isPicked * 2.0 * one)); // picked: radius of 2 pixels at least
  float wide = size.y + one;
  at = vec3(position.x > 0.0 ? size.x + wide : -wide, position.yz * wide);
  vec3 world = start + axes * at;
  ray = parallel ? gaze : world - eye;
  gl_Position = part > 0.0 ? projectionMatrix * viewMatrix * vec4(world, 1.0) : vec4(0, 0, 2, 1);
}
