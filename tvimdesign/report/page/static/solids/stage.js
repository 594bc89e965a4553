// The stage that the parts stand on: camera, lights, orbit controls, pictures. Draws only when something has changed.
import {
  Box3, DirectionalLight, HemisphereLight, Mesh, OrbitControls, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "page/vendor/three.js";

/** Directions from which the module is looked at. */
export const VIEWS = { corner: [1, -1.35, 0.75], top: [0, -0.001, 1], front: [0, -1, 0], side: [1, 0, 0], below: [0.6, -0.8, -0.9] };
const TURN = 0.12; // rad a key
const CLICK = 5; // px that the pointer may move in a click

const MARGIN = 1.04;
const ROUNDS = 3; // of putting the picture's middle on what is seen

const SAMPLES = 4000; // points of a part that the picture is fitted to, at most

/** Points of what is seen below a node, where they stand. A box's corners would stick out of a round module. */
function points(scene) {
  /** @type {Vector3[]} */
  const found = [];
  scene.updateMatrixWorld(true);
  scene.traverseVisible((node) => {
    if (!(node instanceof Mesh)) return;
    const positions = node.geometry.getAttribute("position");
    const stride = Math.ceil(positions.count / SAMPLES);
    for (let i = 0; i < positions.count; i += stride) found.push(new Vector3().fromBufferAttribute(positions, i).applyMatrix4(node.matrixWorld));
  });
  return found;
}

export class Stage {
  constructor(place, says) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${says} Arrow keys turn it, plus and minus come nearer and go away.`);
    place.append(this.canvas);
    this.place = place;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(28, 1, 1, 5000);
    this.camera.up.set(0, 0, 1);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(0.4, 0.6, 1);
    this.camera.add(sun);
    const sky = new HemisphereLight(0xffffff, 0x8a8f99, 1.5);
    sky.position.set(0, 0, 1);
    this.scene.add(this.camera, sky);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener("change", () => this.renew());
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.fit()).observe(place);
    this.frames = 0;
  }

  /** Draw before the next frame, once. */
  renew() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.drawNow();
    });
  }

  drawNow() {
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
  }

  /** Take the size of the place on the page. */
  fit() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.drawNow();
  }

  /** Look from a direction, or on from the one of now, so that everything that is seen is in the picture, and fills it. */
  look(view) {
    const middle = this.bounds().getCenter(new Vector3());
    const away = view ? new Vector3(...VIEWS[view]) : this.camera.position.clone().sub(this.controls.target);
    away.normalize();
    const right = new Vector3().crossVectors(this.camera.up, away).normalize();
    const up = new Vector3().crossVectors(away, right);
    const high = Math.tan((this.camera.fov * Math.PI) / 360);
    const axes = [{ axis: up, half: high }, { axis: right, half: high * this.camera.aspect }];
    const seen = points(this.scene);
    let reach = 1;
    for (let round = 0; round < ROUNDS; round += 1) {
      const from = seen.map((point) => point.clone().sub(middle));
      reach = MARGIN * from.reduce((farthest, one) => Math.max(farthest, ...axes.map(({ axis, half }) => one.dot(away) + Math.abs(one.dot(axis)) / half)), 1);
      if (round === ROUNDS - 1) break;
      // What is near is drawn larger: the middle of the box is not the middle of the picture.
      for (const { axis } of axes) {
        const at = from.map((one) => one.dot(axis) / (reach - one.dot(away)));
        const [low, top] = at.reduce(([least, most], one) => [Math.min(least, one), Math.max(most, one)], [0, 0]);
        middle.addScaledVector(axis, 0.5 * (low + top) * reach);
      }
    }
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(away, reach);
    this.controls.update();
    this.renew();
  }

  /** Box around everything that is seen. */
  bounds() {
    const box = new Box3();
    this.scene.updateMatrixWorld(true);
    this.scene.traverseVisible((node) => { if (node instanceof Mesh) box.expandByObject(node); });
    return box;
  }

  /** Turn and zoom by keys. */
  key(event) {
    const turn = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, -TURN], ArrowDown: [0, TURN] }[event.key];
    const nearer = { "+": 0.9, "=": 0.9, "-": 1.1 }[event.key];
    if (!turn && !nearer) return;
    event.preventDefault();
    const arm = this.camera.position.clone().sub(this.controls.target);
    if (nearer) arm.multiplyScalar(nearer);
    else {
      arm.applyAxisAngle(new Vector3(0, 0, 1), turn[0]);
      const tilt = Math.min(Math.max(Math.acos(arm.z / arm.length()) + turn[1], 0.02), Math.PI - 0.02);
      const flat = Math.hypot(arm.x, arm.y) || 1;
      const length = arm.length();
      arm.set(arm.x / flat * Math.sin(tilt), arm.y / flat * Math.sin(tilt), Math.cos(tilt)).multiplyScalar(length);
    }
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.renew();
  }

  /** Call `told` with the part that was clicked; null beside all parts. */
  onPick(told) {
    /** @type {number[] | null} */
    let from = null;
    this.canvas.addEventListener("pointerdown", ({ clientX, clientY }) => { from = [clientX, clientY]; });
    this.canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (from && Math.hypot(clientX - from[0], clientY - from[1]) < CLICK) told(this.partAt(clientX, clientY));
      from = null;
    });
  }

  partAt(clientX, clientY) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(2 * (clientX - left) / width - 1, 1 - 2 * (clientY - top) / height), this.camera);
    const seen = ray.intersectObjects(this.scene.children, true).filter((/** @type {any} */ { object, point }) =>
      object.userData.part?.object.visible && (object.material.clippingPlanes ?? []).every((plane) => plane.distanceToPoint(point) >= 0));
    return seen[0]?.object.userData.part ?? null;
  }

  /** A picture of what is seen now, of another size, as an address. */
  picture(width, height, view = "corner") {
    const [position, target, aspect] = [this.camera.position.clone(), this.controls.target.clone(), this.camera.aspect];
    const size = this.renderer.getSize(new Vector2());
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.look(view);
    this.drawNow();
    const address = this.canvas.toDataURL("image/png");
    this.renderer.setSize(size.x, size.y, false);
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
    this.drawNow();
    return address;
  }
}
