// Closes cut solids: where the inside of a solid shows behind the cutting plane, it is painted flat,
// with hatching that lies in the plane, so that it looks like a cut face. It comes forward by a
// hair to hide the edges it carries. Needs no stencil and no geometry of its own.
import { BackSide, ShaderMaterial } from "three";

const vertex = `
varying vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const fragment = `
uniform vec4 plane;
uniform vec3 tone;
uniform float spacing;
uniform float slope;
uniform float hair;
uniform mat4 toClip;
varying vec3 place;
void main() {
  float behind = dot(plane.xyz, place) + plane.w;
  if (behind < 0.0) discard;
  vec3 ray = place - cameraPosition;
  float along = -(dot(plane.xyz, cameraPosition) + plane.w) / dot(plane.xyz, ray);
  if (along < 0.0 || along > 1.0) discard;
  vec3 cut = cameraPosition + along * ray;
  vec3 across = normalize(cross(plane.xyz, vec3(0.0, 0.0, 1.0)));
  float stripe = 1.0;
  if (spacing > 0.0) {
    float u = (dot(cut, across) * slope + cut.z) / spacing;
    float w = max(fwidth(u), 1e-6);
    float d = abs(fract(u) - 0.5);
    stripe = 1.0 - 0.42 * (1.0 - smoothstep(0.07, 0.07 + w, 0.5 - d));
  }
  float forward = max(along, 1.0 - hair / length(ray));
  vec4 clip = toClip * vec4(cameraPosition + forward * ray, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  gl_FragColor = vec4(tone * stripe, 1.0);
  #include <colorspace_fragment>
}`;

// Material of one part's cut faces; `shared` holds the uniforms all parts have in common.
export function capMaterial(colour, spacing, slope, shared) {
  return new ShaderMaterial({
    vertexShader: vertex,
    fragmentShader: fragment,
    side: BackSide,
    uniforms: {
      plane: shared.plane,
      toClip: shared.toClip,
      hair: shared.hair,
      tone: { value: colour },
      spacing: { value: spacing },
      slope: { value: slope },
    },
  });
}
