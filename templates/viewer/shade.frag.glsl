// Computes the light that one texel of the vessels' surface gets from one direction, and the light that it would get
// without other vessels.
precision highp float;
precision highp int;

uniform highp sampler2D segments; // start and radius, then end
uniform highp sampler2D depths; // the shadow map of the direction
uniform mat4 fromWorld;
uniform vec3 towards;
uniform float texel, deep; // width of a texel of the shadow map, and its depth range, mm
uniform int count;

out vec4 light;

vec4 segmentPart(int k) { return texelFetch(segments, ivec2(k % WIDTH, k / WIDTH), 0); }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), cell = ivec2(at.x % AROUND, at.y % ALONG);
  int k = at.y / ALONG * (WIDTH / AROUND) + at.x / AROUND;
  if (k >= count) discard;
  vec4 start = segmentPart(2 * k);
  vec3 end = segmentPart(2 * k + 1).xyz, u = normalize(end - start.xyz);
  vec3 v = normalize(cross(u, abs(u.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0))), w = cross(u, v);
  float turn = 6.2831853 * (float(cell.x) + 0.5) / float(AROUND);
  vec3 normal = cos(turn) * v + sin(turn) * w;
  float cosine = dot(normal, towards);
  if (cosine <= 0.0) discard;
  vec3 point = mix(start.xyz, end, (float(cell.y) + 0.5) / float(ALONG)) + normal * (start.w + texel);
  vec3 seen = 0.5 * (fromWorld * vec4(point, 1.0)).xyz + 0.5;
  float reached = texture(depths, seen.xy).r >= seen.z - texel / deep ? 1.0 : 0.0;
  light = vec4(cosine * reached, cosine, 0.0, 0.0);
}
