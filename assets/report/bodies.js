// The bodies of the scene as objects of three.js: body, wheels, thrusters with plumes, debris, axes, vectors, the sphere of s3.

import { HUE_PLACES } from "./theme.js";

// A material of one colour.
function material(three, color, opacity = 1) {
  return new three.MeshLambertMaterial({ color, transparent: opacity < 1, opacity, side: three.DoubleSide, depthWrite: opacity === 1 });
}

function edges(three, geometry, color) {
  return new three.LineSegments(new three.EdgesGeometry(geometry, 30), new three.LineBasicMaterial({ color }));
}

function edged(three, geometry, color, opacity, edge) {
  const group = new three.Group();
  group.add(new three.Mesh(geometry, material(three, color, opacity)));
  group.add(edges(three, geometry, edge));
  return group;
}

// A cylinder along z.
function cylinder(three, radius, length, segments = 40) {
  return new three.CylinderGeometry(radius, radius, length, segments).rotateX(Math.PI / 2);
}

export function quaternionOf(three, [w, x, y, z]) {
  return new three.Quaternion(x, y, z, w);
}

// The rotation that turns z into `direction`.
export function towards(three, direction) {
  const to = new three.Vector3(...direction).normalize();
  return new three.Quaternion().setFromUnitVectors(new three.Vector3(0, 0, 1), to);
}

function partGeometry(three, part) {
  const [a, b, c] = part.size;
  if (part.shape === "hollow_cylinder" || part.shape === "solid_cylinder") return cylinder(three, a, b);
  if (part.shape === "box") return new three.BoxGeometry(a, b, c);
  return new three.SphereGeometry(part.shape === "sphere" ? a : 0.05, 24, 16);
}

// The body: its parts in F_s, translucent so that the wheels are seen; edges alone where `color` is given.
export function bodyGroup(three, scene, palette, color) {
  const group = new three.Group();
  for (const part of scene.parts) {
    const geometry = partGeometry(three, part);
    const hue = palette.hues[HUE_PLACES.body];
    const object = color ? edges(three, geometry, color) : edged(three, geometry, hue, 0.22, hue);
    object.position.set(...part.position);
    const [r0, r1, r2] = part.turn;
    object.quaternion.setFromRotationMatrix(new three.Matrix4().set(...r0, 0, ...r1, 0, ...r2, 0, 0, 0, 0, 1));
    group.add(object);
  }
  return group;
}

// The plates that air and light push, as thin squares of their areas; edges alone where `color` is given.
export function plateGroup(three, scene, palette, color) {
  const group = new three.Group();
  for (const { side, normal, center } of scene.plates) {
    const geometry = new three.BoxGeometry(side, side, 0.002 * side);
    const object = color ? edges(three, geometry, color) : edged(three, geometry, palette.quiet, 0.3, palette.text);
    object.position.set(...center);
    object.quaternion.copy(towards(three, normal));
    group.add(object);
  }
  return group;
}

// A wheel whose turning is seen by its spokes.
export function wheelGroup(three, wheel, index, palette) {
  const color = palette.hues[HUE_PLACES.wheels[index % HUE_PLACES.wheels.length]];
  const group = new three.Group();
  group.position.set(...wheel.position);
  group.quaternion.copy(towards(three, wheel.axis));
  const spinning = new three.Group();
  spinning.add(edged(three, cylinder(three, wheel.radius, wheel.length), color, 0.9, palette.text));
  const spoke = new three.BoxGeometry(1.9 * wheel.radius, 0.16 * wheel.radius, 1.04 * wheel.length);
  spinning.add(new three.Mesh(spoke, material(three, palette.background)));
  group.add(spinning);
  return { group, spinning };
}

export function thrusterGroup(three, thruster, size, palette) {
  const group = new three.Group();
  group.position.set(...thruster.position);
  group.quaternion.copy(towards(three, thruster.direction.map((value) => -value)));
  const nozzle = new three.ConeGeometry(0.05 * size, 0.1 * size, 20, 1, true).rotateX(-Math.PI / 2);
  nozzle.translate(0, 0, 0.05 * size);
  group.add(new three.Mesh(nozzle, material(three, palette.quiet)));
  const plume = new three.Mesh(new three.ConeGeometry(0.09 * size, 0.5 * size, 20, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.32 * size), material(three, palette.hues[5], 0.65));
  plume.visible = false;
  group.add(plume);
  return { group, plume };
}

export function debrisGroup(three, size, palette) {
  return edged(three, new three.BoxGeometry(...size), palette.hues[HUE_PLACES.debris], 0.9, palette.text);
}

// An arrow along z of length one, scaled and turned by `pointTo`.
export function arrow(three, color, thickness) {
  const group = new three.Group();
  const shaft = new three.Mesh(cylinder(three, thickness, 0.85, 12).translate(0, 0, 0.425), new three.MeshBasicMaterial({ color }));
  const tip = new three.Mesh(new three.ConeGeometry(3 * thickness, 0.15, 16).rotateX(Math.PI / 2).translate(0, 0, 0.925), new three.MeshBasicMaterial({ color }));
  group.add(shaft, tip);
  return group;
}

export function pointTo(three, object, vector, length) {
  const size = Math.hypot(...vector);
  object.visible = size > 0;
  if (size === 0) return;
  object.quaternion.copy(towards(three, vector));
  object.scale.set(length, length, length);
}

// Three axes from the origin.
export function axes(three, length, color) {
  const points = new Float32Array([0, 0, 0, length, 0, 0, 0, 0, 0, 0, length, 0, 0, 0, 0, 0, 0, length]);
  const geometry = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(points, 3));
  return new three.LineSegments(geometry, new three.LineBasicMaterial({ color }));
}

// A curve on the sphere of s3.
export function curve(three, points, radius, color) {
  const flat = Float32Array.from(points.flat(), (value) => radius * value);
  const geometry = new three.BufferGeometry().setAttribute("position", new three.BufferAttribute(flat, 3));
  return new three.Line(geometry, new three.LineBasicMaterial({ color }));
}

export function sphere(three, radius, color, opacity = 0.09) {
  return new three.Mesh(new three.SphereGeometry(radius, 24, 12), new three.MeshBasicMaterial({ color, wireframe: true, transparent: true, opacity }));
}
