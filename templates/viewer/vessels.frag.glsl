// Intersects a ray with a cylinder with round ends, and shades the hit in soft light, or by POV-Ray's light model as
// corcast's pictures do (METHODS section 3). Floats are too coarse for distances from the ray's start, which may be 10^4 radii away. So
// all distances are measured from a point on the box, and by cross products. The fraction of the pixel that the vessel
// covers becomes the coverage of the pixel's samples.
precision highp float;
precision highp int;

flat in mat3 axes;
flat in vec3 from;
flat in vec2 size;
flat in vec3 pigment;
flat in float isPicked;
flat in int number;
in vec3 at, ray;

uniform mat4 viewMatrix, projectionMatrix;
uniform bool parallel;
uniform float pixel;
uniform float ambient, diffuse, brilliance, phong, phongSize, specular, sharpness;
uniform float lightIsPoint[LIGHTS];
uniform vec3 lightPosition[LIGHTS], lightColor[LIGHTS];
uniform float halfDiagonal;
uniform vec3 paper, accent; // the paper's color is sRGB
uniform float fade;
uniform highp sampler2D open; // sums of the light that arrives, and of the light without other vessels [shade.js]
uniform bool isSoft;
uniform float form; // soft light: strength of light and dark, from 0 (the plain color) to 1
uniform float shade, rim, edge; // strengths of the ambient occlusion, of light and of darkness at outlines, 0..1

out vec4 seen;

// Returns the parameter t where the ray enters the solid. The ray must pass the axis at less than the radius.
float entry(vec3 p, vec3 d, float len, float r) {
  float a = max(dot(d.yz, d.yz), 1e-12), aside = p.y * d.z - p.z * d.y;
  float t = (-dot(p.yz, d.yz) - sqrt(max(0.0, a * r * r - aside * aside))) / a;
  float x = p.x + t * d.x;
  if (x >= 0.0 && x <= len) return t;
  vec3 q = p - vec3(x < 0.0 ? 0.0 : len, 0.0, 0.0);
  float along = dot(q, d);
  vec3 off = q - along * d;
  return -along - sqrt(max(0.0, r * r - dot(off, off)));
}

vec3 lit(vec3 point, vec3 normal, vec3 view, vec3 color) {
  vec3 sum = color * ambient;
  for (int i = 0; i < LIGHTS; i++) {
    vec3 middle = (viewMatrix * vec4(0, 0, 0, 1)).xyz;
    vec3 towards = lightIsPoint[i] > 0.5 ? middle + halfDiagonal * lightPosition[i] - point : lightPosition[i];
    towards = normalize(towards);
    float cosine = dot(normal, towards);
    if (cosine <= 0.0) continue;
    float mirrored = dot(reflect(view, normal), towards);
    float halfway = dot(normalize(towards - view), normal);
    vec3 light = color * diffuse * pow(cosine, brilliance);
    if (phong > 0.0 && mirrored > 0.0) light += phong * pow(mirrored, phongSize);
    if (specular > 0.0 && halfway > 0.0) light += specular * pow(halfway, sharpness);
    sum += lightColor[i] * light;
  }
  return sum;
}

// Soft light: a hemisphere, brighter above, and a wide lamp at the upper left, whose light wraps around the vessel.
// `visible` is the ambient visibility. A surface that faces the lamp and sees all of the hemisphere has the color itself.
vec3 softlyLit(vec3 normal, vec3 view, float visible, vec3 color) {
  const vec3 LAMP = vec3(-0.37, 0.5, 0.783);
  float wrapped = max(0.0, dot(normal, LAMP) + 0.35) / 1.35;
  float light = mix(0.16, 0.4, 0.5 + 0.5 * normal.y) * visible + 0.75 * wrapped * mix(0.4, 1.0, visible);
  float gleam = pow(max(0.0, dot(normalize(LAMP - view), normal)), 30.0) * visible;
  return color * mix(1.0, light, form) + 0.16 * form * form * gleam;
}

float openTexel(int around, int along) {
  int cell = number % (WIDTH / AROUND) * AROUND, line = number / (WIDTH / AROUND) * ALONG;
  vec2 sums = texelFetch(open, ivec2(cell + (around + AROUND) % AROUND, line + clamp(along, 0, ALONG - 1)), 0).xy;
  return sums.y > 0.0 ? sums.x / sums.y : 1.0;
}

// Returns the ambient visibility of the surface, from 0 to 1, interpolated between the nearest texels.
float openness(vec3 normal, float part) {
  float around = atan(normal.z, normal.y) / 6.2831853 * float(AROUND) - 0.5, along = part * float(ALONG) - 0.5;
  int i = int(floor(around)), k = int(floor(along));
  float x = around - floor(around), y = along - floor(along);
  return mix(mix(openTexel(i, k), openTexel(i + 1, k), x), mix(openTexel(i, k + 1), openTexel(i + 1, k + 1), x), y);
}

vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  float len = size.x, r = size.y;
  vec3 d = normalize(ray * axes);
  float a = max(dot(d.yz, d.yz), 1e-12);
  float core = clamp(at.x - d.x * dot(at.yz, d.yz) / a, 0.0, len); // the point of the axis that is nearest to the ray
  vec3 q = at - vec3(core, 0.0, 0.0);
  float along = -dot(q, d);
  vec3 off = q + along * d;
  float apart = length(off);

  float h = 0.5 * pixel * (parallel ? 1.0 : length(ray) + along);
  float cover = (min(r, apart + h) - max(-r, apart - h)) / (2.0 * h);
#ifdef DEPTHS
  // A vessel thinner than a pixel is drawn with the probability of its coverage, so that the mean over all shadow maps
  // is darkened by the coverage.
  if (cover <= fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))))) discard;
#else
  if (cover <= 0.0) discard;
#endif

  float t = apart < r ? entry(at, d, len, r) : along;
  vec3 hit = at + t * d;
  vec3 normal = normalize(hit - vec3(clamp(hit.x, 0.0, len), 0.0, 0.0));
  vec4 point = viewMatrix * vec4(from + axes * hit, 1.0);
  vec4 clip = projectionMatrix * point;
  gl_FragDepth = clamp(0.5 * clip.z / clip.w + 0.5, 0.0, 1.0) * (1.0 - 0.999 * isPicked); // picked: in front of all

  seen = vec4(0);
#ifndef DEPTHS
  mat3 toView = mat3(viewMatrix) * axes;
  float visible = shade > 0.0 ? mix(1.0, openness(normal, hit.x / max(len, 1e-9)), shade) : 1.0;
  float slope = 1.0 - abs(dot(normal, d)); // 1 at the outline
  vec3 inEye = toView * normal, view = toView * d;
  vec3 color = isSoft ? softlyLit(inEye, view, visible, pigment) : lit(point.xyz, inEye, view, pigment) * visible;
  color = mix(color, accent, 0.8 * isPicked);
  color = color * (1.0 - edge * slope * slope) + rim * slope * slope * slope; // separates vessels from the background
  float middle = (viewMatrix * vec4(0, 0, 0, 1)).z;
  float depth = clamp(0.5 + 0.5 * (middle - point.z) / halfDiagonal, 0.0, 1.0);
  seen = vec4(mix(encoded(color), paper, fade * depth * (1.0 - isPicked)), cover);
#endif
}
