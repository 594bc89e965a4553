// The module's parts as meshes in the module's own coordinates: millimetres, the rotor's axis upwards.
import {
  BackSide, Color, DoubleSide, EdgesGeometry, FrontSide, GLTFLoader, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshStandardMaterial,
} from "page/vendor/three.js";

const FROM_GLTF = new Matrix4().set(1000, 0, 0, 0, 0, 0, -1000, 0, 0, 1000, 0, 0, 0, 0, 0, 1);
const TAKEN = new Color(0xffb000);
const SHARP = 30; // degrees between two faces whose edge is drawn
const known = new WeakMap();

/** The sharp edges of a mesh, found once for all its copies. */
function edgesOf(geometry) {
  if (!known.has(geometry)) known.set(geometry, new EdgesGeometry(geometry, SHARP));
  return known.get(geometry);
}

/** Every part of a GLB by name, with its data. Copies of a kind share their mesh; polymer has its own. */
export async function readParts(binary, told) {
  const { scene } = await new GLTFLoader().parseAsync(binary, "");
  scene.updateMatrixWorld(true);
  const named = new Map(told.map((part) => [part.name, part]));
  const parts = new Map();
  scene.traverse((/** @type {any} */ node) => {
    const about = named.get(node.name) ?? named.get(node.userData.name);
    if (!node.isMesh || !about) return;
    const rest = FROM_GLTF.clone().multiply(node.matrixWorld);
    parts.set(about.name, new Part({ geometry: node.geometry, colour: node.material.color, rest, edges: edgesOf(node.geometry) }, about));
  });
  return parts;
}

/** One part: where it stands, how far it is lifted and turned, whether it is seen. */
export class Part {
  constructor({ geometry, colour, rest, edges }, about) {
    Object.assign(this, about);
    this.turns = about.turns;
    this.isLayer = about.kind === "pcl_arc" || about.kind === "pcl_block";
    this.rest = rest;
    this.geometry = this.isLayer ? geometry.clone() : geometry;
    this.outside = new MeshStandardMaterial({ color: colour, roughness: 0.65, metalness: 0.1, side: FrontSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    // What is cut open shows its inside in one flat colour, which looks like the face of the cut.
    this.inside = new MeshBasicMaterial({ color: colour.clone().multiplyScalar(0.55), side: BackSide });
    this.object = new Group();
    this.object.matrixAutoUpdate = false;
    this.object.add(new Mesh(this.geometry, this.outside), new Mesh(this.geometry, this.inside));
    for (const mesh of this.object.children) mesh.userData.part = this;
    this.edge = new LineBasicMaterial({ color: 0x11161d, transparent: true, opacity: 0.55 });
    if (!about.kind.startsWith("spring_")) this.object.add(new LineSegments(edges, this.edge));
    this.hidden = false;
    this.later = false;
    this.lifted = 0;
    this.angle = 0;
    this.place();
  }

  /** Put it where its lift [mm] and the rotor's angle [rad] have it. */
  place() {
    const lift = new Matrix4().makeTranslation(0, 0, this.lifted);
    this.object.matrix.copy(lift.multiply(new Matrix4().makeRotationZ(this.turns ? this.angle : 0)).multiply(this.rest));
    this.object.visible = !this.hidden && !this.later;
  }

  /** Take another shape and place: the design has moved. */
  reshape({ geometry, rest, edges }, lift) {
    this.geometry = geometry;
    for (const one of this.object.children) {
      if (one instanceof LineSegments) one.geometry = edges;
      else if (one instanceof Mesh) one.geometry = geometry;
    }
    this.rest = rest;
    this.lift = lift;
    this.place();
  }

  /** Mark it as the one that was picked, or not. */
  mark(yes) {
    this.outside.emissive = yes ? TAKEN : new Color(0);
    this.outside.emissiveIntensity = yes ? 0.35 : 0;
  }

  /** Cut it by planes. */
  cut(planes) {
    this.outside.clippingPlanes = this.inside.clippingPlanes = this.edge.clippingPlanes = planes;
    this.outside.side = planes.length ? FrontSide : DoubleSide;
    this.outside.needsUpdate = true;
  }
}
