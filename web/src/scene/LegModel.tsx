import { useRef, type RefObject } from "react";
import { Quaternion, Vector3, type Group, type Mesh, type MeshStandardMaterial } from "three";

import type { Palette } from "./palette";
import { pointOf, turn, type Frame, type Placed } from "./frame";
import { useStage } from "./useStage";

const UP = new Vector3(0, 1, 0);
const from = new Vector3();
const to = new Vector3();
const along = new Vector3();
const turned = new Quaternion();

interface Props {
  leg: number;
  colour: string;
  footRadius: number;
  /** Thickness of the links [mm]. */
  thick: number;
  palette: Palette;
}

/** A leg: three links between four points, and the foot in the leg's colour. */
export function LegModel({ leg, colour, footRadius, thick, palette }: Props) {
  const links = [useRef<Mesh>(null), useRef<Mesh>(null), useRef<Mesh>(null)] as const;
  const joints = [useRef<Group>(null), useRef<Group>(null), useRef<Group>(null)] as const;
  const foot = useRef<Mesh>(null);

  useStage((frame) => {
    const troubled = frame.trouble[leg] != null;
    const marked = (i: number) =>
      frame.highlight?.leg === leg && (frame.highlight.joint === null || frame.highlight.joint === i);
    const colourOf = (i: number) => (troubled ? palette.trouble : marked(i) ? palette.mark : palette.link);
    links.forEach((link, i) => placeLink(link, frame, leg, i, colourOf(i)));
    joints.forEach((joint, i) => {
      placeJoint(joint, frame, leg, i);
      const strained = frame.physical?.saturated[leg * 3 + i] ?? false;
      const mesh = joint.current?.children[0] as Mesh | undefined;
      (mesh?.material as MeshStandardMaterial | undefined)?.color.set(
        strained ? palette.trouble : marked(i) ? palette.mark : palette.joint,
      );
    });
    foot.current?.position.set(...pointOf(frame, leg, 3));
  });

  // Tapered towards the foot, like printed and milled legs.
  const widths = [
    [1, 1],
    [0.95, 1],
    [0.42, 0.9],
  ] as const;
  return (
    <group>
      {links.map((link, i) => (
        <mesh key={i} ref={link} castShadow>
          <cylinderGeometry
            args={[thick * (widths[i]?.[0] ?? 1), thick * (widths[i]?.[1] ?? 1), 1, 20, 1, false]}
          />
          <meshStandardMaterial roughness={0.55} metalness={0.15} />
        </mesh>
      ))}
      {joints.map((joint, i) => (
        <group key={i} ref={joint}>
          <mesh castShadow>
            <cylinderGeometry args={[thick * 1.25, thick * 1.25, thick * 2.3, 24]} />
            <meshStandardMaterial roughness={0.5} metalness={0.25} />
          </mesh>
        </group>
      ))}
      <mesh ref={foot} castShadow>
        <sphereGeometry args={[Math.max(footRadius, thick * 0.6), 24, 16]} />
        <meshStandardMaterial color={colour} roughness={0.6} />
      </mesh>
    </group>
  );
}

function placeLink(ref: RefObject<Mesh | null>, frame: Frame, leg: number, i: number, colour: string) {
  const mesh = ref.current;
  if (!mesh) return;
  span(mesh, frame, leg, i);
  (mesh.material as MeshStandardMaterial).color.set(colour);
}

/** Place a cylinder of length 1 along a link; a coxa of length zero is not drawn. */
export function span(mesh: Mesh, frame: Placed, leg: number, i: number): void {
  from.set(...pointOf(frame, leg, i));
  to.set(...pointOf(frame, leg, i + 1));
  along.subVectors(to, from);
  const length = along.length();
  mesh.visible = length > 0.01;
  if (!mesh.visible) return;
  mesh.position.addVectors(from, to).multiplyScalar(0.5);
  mesh.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
  mesh.scale.set(1, length, 1);
}

/** Joints are cylinders along their axes: the body's z axis for the coxa, across the leg for the others. */
function placeJoint(ref: RefObject<Group | null>, frame: Frame, leg: number, i: number) {
  const group = ref.current;
  if (!group) return;
  group.position.set(...pointOf(frame, leg, i));
  const upright = new Vector3(...turn(frame.rotation, [0, 0, 1]));
  if (i > 0) {
    to.set(...pointOf(frame, leg, 3)).sub(from.set(...pointOf(frame, leg, 0)));
    along.crossVectors(upright, to);
    if (along.lengthSq() > 1) upright.copy(along).normalize();
  }
  group.quaternion.copy(turned.setFromUnitVectors(UP, upright));
}
