import { useFrame } from "@react-three/fiber";
import { useMemo, type RefObject } from "react";
import { Vector3 } from "three";

import { footOf, pointOf, type Frame, type Vec3 } from "./frame";
import { forceText } from "./forceText";
import { stage } from "./stage";

/** Height of a label above the knee [mm]. */
const OVER = 34;
/** Depth of the label of a force below the foot [mm]. */
const UNDER = 26;
/** Minimum distance of a label from the edge of the 3D view [px]. */
const EDGE = 4;

/** Moves the labels with the objects that they belong to, in the same frame. */
export function LabelPositions({ layer }: { layer: RefObject<HTMLDivElement | null> }) {
  const at = useMemo(() => new Vector3(), []);
  useFrame(({ camera, size }) => {
    const notes = layer.current?.children;
    const frame = stage.current;
    if (!notes || !frame) return;
    const legs = frame.contacts.length;
    for (let i = 0; i < notes.length; i++) {
      const note = notes[i] as HTMLElement;
      at.set(...placeOf(frame, i, legs)).project(camera);
      const seen = at.z < 1 && at.z > -1;
      note.style.visibility = seen ? "" : "hidden";
      const [x, y] = [((at.x + 1) / 2) * size.width, ((1 - at.y) / 2) * size.height];
      note.style.transform = `translate(${across(x, size.width)}, ${y.toFixed(1)}px) translateY(-50%)`;
    }
    writeMargin(notes[legs]?.firstElementChild, frame);
    for (let leg = 0; leg < legs; leg++) writeForce(notes[legs + 1 + leg]?.firstElementChild, frame, leg);
  });
  return null;
}

/** Centred on its object, but fully inside the 3D view. */
function across(x: number, width: number): string {
  const left = `${x.toFixed(1)}px - 50%`;
  if (x < 0 || x > width) return `calc(${left})`;
  return `clamp(${EDGE}px, ${left}, ${width - EDGE}px - 100%)`;
}

/** Labels are those of the legs, that of the margin, and those of the forces. */
function placeOf(frame: Frame, label: number, legs: number): Vec3 {
  if (label < legs) return anchorOf(frame, label);
  return label === legs ? marginPlace(frame) : footLabel(frame, label - legs - 1);
}

/** Below the foot, so that neither the arrow nor the leg is hidden. */
function footLabel(frame: Frame, leg: number): Vec3 {
  const [x, y, z] = footOf(frame, leg);
  return [x, y, z - UNDER];
}

function anchorOf(frame: Frame, leg: number): Vec3 {
  const [x, y, z] = pointOf(frame, leg, 2);
  return [x, y, z + OVER];
}

function marginPlace(frame: Frame): Vec3 {
  return frame.com ? [frame.com[0], frame.com[1], 2] : frame.position;
}

function writeMargin(note: Element | null | undefined, { com, margin }: Frame) {
  if (!(note instanceof HTMLElement)) return;
  note.hidden = com === null || margin === null;
  if (margin === null) return;
  note.textContent = margin < 0 ? `tips over: ${margin.toFixed(0)} mm` : `${margin.toFixed(0)} mm`;
  note.classList.toggle("bad", margin < 0);
}

function writeForce(note: Element | null | undefined, { forces }: Frame, leg: number) {
  if (!(note instanceof HTMLElement)) return;
  note.textContent = forceText(forces, leg);
  note.hidden = note.textContent === "";
}
