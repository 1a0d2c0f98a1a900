// The machine in three dimensions: turn it, take it apart, cut it. Started by the report's page.
import {
  Box3,
  Color,
  DirectionalLight,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  NeutralToneMapping,
  PerspectiveCamera,
  Plane,
  PMREMGenerator,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  Vector4,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { capMaterial } from "./cap.js";
import { bodyPose } from "./motion.js";

export { bodyPose };

export function decode(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i += 1) {
    bytes[i] = raw.charCodeAt(i);
  }
  return bytes.buffer;
}

// Whether this browser can draw in three dimensions, asked without a word on its console.
export function canDraw() {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    const loose = context && context.getExtension("WEBGL_lose_context");
    if (loose) {
      loose.loseContext();
    }
    return Boolean(context);
  } catch (error) {
    return false;
  }
}

// Builds the view inside `host` and resolves to its handle: set({crank, explode, section}), state().
export async function start(host, glb, onPick) {
  const gltf = await new GLTFLoader().parseAsync(glb, "");
  const root = gltf.scene.children[0];
  const mechanism = root.userData;
  const renderer = new WebGLRenderer({ antialias: true, alpha: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.toneMapping = NeutralToneMapping;
  renderer.toneMappingExposure = 1.0;
  renderer.localClippingEnabled = true;
  host.appendChild(renderer.domElement);

  const scene = new Scene();
  const studio = new PMREMGenerator(renderer);
  scene.environment = studio.fromScene(new RoomEnvironment(), 0.03).texture;
  scene.environmentIntensity = 0.95;
  const key = new DirectionalLight(0xffffff, 1.7);
  key.position.set(0.35, -1.0, 1.2);
  const rim = new DirectionalLight(0xdde8ff, 0.9);
  rim.position.set(1.0, 0.6, -0.2);
  scene.add(key, rim);

  // The machine keeps its own frame, z along the axis, metres; it lies with its axis to the right.
  const machine = new Group();
  machine.quaternion.setFromRotationMatrix(
    new Matrix4().makeBasis(new Vector3(0, 0, 1), new Vector3(0, -1, 0), new Vector3(1, 0, 0)),
  );
  scene.add(machine);
  const plane = new Plane(new Vector3(0, 1, 0), 1);
  const shared = { plane: { value: new Vector4() }, toClip: { value: new Matrix4() }, hair: { value: 0 } };
  const ink = new LineBasicMaterial({ color: 0x10161c, transparent: true, opacity: 0.62 });
  const shades = new Map();
  const pieces = [];

  function looks(mesh, data) {
    let found = shades.get(data.part);
    if (!found) {
      const colour = mesh.material.color.clone();
      const surface = new MeshStandardMaterial({
        color: colour,
        metalness: data.metalness,
        roughness: data.roughness,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
      const flat = colour.clone().lerp(new Color(1, 1, 1), 0.12);
      const cap = capMaterial(flat, data.hatch, data.slope, shared);
      found = { surface, cap, edges: new EdgesGeometry(mesh.geometry, 28) };
      shades.set(data.part, found);
    }
    return found;
  }

  for (const node of root.children) {
    const data = node.userData;
    const source = node.isMesh ? node : node.getObjectByProperty("isMesh", true);
    const look = looks(source, data);
    const piece = new Group();
    const held = new Group();
    held.applyMatrix4(new Matrix4().fromArray(data.placement));
    const surface = new Mesh(source.geometry, look.surface);
    const cap = new Mesh(source.geometry, look.cap);
    const lines = new LineSegments(look.edges, ink);
    for (const item of [surface, cap, lines]) {
      // Quantised positions: the node's own scale and offset give metres.
      item.position.copy(source.position);
      item.scale.copy(source.scale);
    }
    cap.visible = false;
    surface.userData = data;
    held.add(surface, cap, lines);
    piece.add(held);
    machine.add(piece);
    pieces.push({ piece, surface, cap, lines, data });
  }

  const shown = { crank: 0, explode: 0, section: 0, picked: "" };
  function pose() {
    for (const { piece, data } of pieces) {
      const at = bodyPose(mechanism, data.body, data.disc || 0, shown.crank);
      piece.position.set(at.x, at.y, shown.explode * data.explode);
      piece.rotation.z = at.angle;
    }
    machine.updateMatrixWorld(true);
  }

  // Box of the machine as it stands, in the scene.
  function extent() {
    return new Box3().setFromObject(machine, true);
  }

  pose();
  const size = extent().getSize(new Vector3());
  const radius = 0.5 * size.length();
  const width = 0.5 * Math.max(size.y, size.z);
  let spread = 0;
  for (const { data } of pieces) {
    spread = Math.max(spread, Math.abs(data.explode));
  }
  shared.hair.value = 0.01 * width;

  const camera = new PerspectiveCamera(24, 1, 0.02 * radius, 60 * (radius + spread));
  camera.up.set(0, 0, 1);
  const view = new Vector3(0.6, -0.74, 0.3).normalize();
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.enableDamping = false;
  controls.minDistance = 0.5 * radius;
  controls.maxDistance = 40 * (radius + spread);

  // Least distance from the middle of a box at which the cylinder in it is in sight.
  function distance(box, from) {
    const high = Math.tan((camera.fov * Math.PI) / 360);
    const right = new Vector3().crossVectors(camera.up, from).normalize();
    const up = new Vector3().crossVectors(from, right);
    const half = box.getSize(new Vector3()).multiplyScalar(0.5);
    let most = 0;
    for (let step = 0; step < 48; step += 1) {
      const turn = (2 * Math.PI * step) / 24;
      const at = new Vector3(
        step < 24 ? half.x : -half.x,
        half.y * Math.cos(turn),
        half.z * Math.sin(turn),
      );
      const near = at.dot(from);
      most = Math.max(
        most,
        near + Math.abs(at.dot(up)) / high,
        near + Math.abs(at.dot(right)) / (high * camera.aspect),
      );
    }
    return 1.04 * most;
  }

  function home() {
    const box = extent();
    box.getCenter(controls.target);
    camera.position.copy(view).multiplyScalar(distance(box, view)).add(controls.target);
    controls.update();
  }

  function cut() {
    const on = shown.section > 0;
    // From the near side of the machine through the axis to its far side.
    plane.constant = width * (1.02 - 2.04 * shown.section);
    const planes = on ? [plane] : null;
    for (const look of shades.values()) {
      look.surface.clippingPlanes = planes;
    }
    ink.clippingPlanes = planes;
    for (const { cap } of pieces) {
      cap.visible = on;
    }
    shared.plane.value.set(plane.normal.x, plane.normal.y, plane.normal.z, plane.constant);
  }
  plane.normal.set(0, 1, 0);

  function draw() {
    camera.updateMatrixWorld();
    shared.toClip.value.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    renderer.render(scene, camera);
  }

  function resize() {
    const across = host.clientWidth;
    const high = host.clientHeight;
    if (across > 0 && high > 0) {
      renderer.setSize(across, high, false);
      camera.aspect = across / high;
      camera.updateProjectionMatrix();
      draw();
    }
  }

  const ray = new Raycaster();
  const bright = new Map();
  function pick(event) {
    const frame = renderer.domElement.getBoundingClientRect();
    const at = new Vector2(
      (2 * (event.clientX - frame.left)) / frame.width - 1,
      1 - (2 * (event.clientY - frame.top)) / frame.height,
    );
    ray.setFromCamera(at, camera);
    const hits = ray.intersectObjects(pieces.map((item) => item.surface), false);
    const on = shown.section > 0;
    const hit = hits.find((item) => !on || plane.distanceToPoint(item.point) >= 0);
    const data = hit ? hit.object.userData : null;
    const name = data ? data.name : "";
    if (name !== shown.picked) {
      shown.picked = name;
      for (const item of pieces) {
        const chosen = item.data.name === name;
        if (chosen && !bright.has(item)) {
          const lit = item.surface.material.clone();
          lit.emissive.set(0x2f6fa5);
          lit.emissiveIntensity = 0.55;
          bright.set(item, item.surface.material);
          item.surface.material = lit;
        } else if (!chosen && bright.has(item)) {
          item.surface.material.dispose();
          item.surface.material = bright.get(item);
          bright.delete(item);
        }
      }
      onPick(data);
      draw();
    }
  }
  renderer.domElement.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) {
      pick(event);
    }
  });
  renderer.domElement.addEventListener("click", pick);
  // The wheel scrolls the page until the model has been taken in hand.
  controls.enableZoom = false;
  renderer.domElement.addEventListener("pointerdown", () => {
    controls.enableZoom = true;
  });
  renderer.domElement.addEventListener("pointerleave", () => {
    controls.enableZoom = false;
  });
  controls.addEventListener("change", draw);
  new ResizeObserver(resize).observe(host);

  resize();
  home();
  cut();
  draw();
  return {
    set(values) {
      const before = extent();
      Object.assign(shown, values);
      pose();
      cut();
      if (values.explode !== undefined) {
        // Step back as the machine grows, from wherever the viewer has gone.
        const after = extent();
        const from = camera.position.clone().sub(controls.target);
        const away = from.clone().normalize();
        const grown = distance(after, away) / distance(before, away);
        controls.target.add(after.getCenter(new Vector3())).sub(before.getCenter(new Vector3()));
        camera.position.copy(from).multiplyScalar(grown).add(controls.target);
        controls.update();
      }
      draw();
    },
    home() {
      home();
      draw();
    },
    state() {
      return {
        ...shown,
        pieces: pieces.map(({ piece, data }) => ({
          name: data.name,
          at: piece.position.toArray(),
          angle: piece.rotation.z,
        })),
      };
    },
  };
}
