import { useEffect, useRef, useState } from "react";

import { isTyping } from "../../app/useShortcuts";
import type { Command } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { keyOf } from "../physics/usePhysics";
import {
  CENTRED,
  gamepadDeflection,
  isCentred,
  isDriveKey,
  keyDeflection,
  sumOf,
  type Deflection,
} from "./deflection";
import type { RequestedState } from "./robotState";

/** Interval at which commands are sent while a stick is deflected [ms]. */
const INTERVAL = 50;

export type BodyPoseValues = readonly [number, number, number, number, number, number];

/** Top speeds, and what is commanded besides the twist. */
export interface Settings {
  speed: number;
  turn: number;
  gait: string | null;
  bodyHeight: number | null;
  swingHeight: number | null;
  /** x, y, z [mm], roll, pitch, yaw [deg] relative to the level body; null to leave it as it is. */
  body: BodyPoseValues | null;
  /** Null to leave it as it is. */
  state: RequestedState | null;
}

export interface Sticks {
  walk: (x: number, y: number) => void;
  turn: (x: number) => void;
}

/** How often the physics have changed: also where they are the same again before the page is drawn. */
function useChangesOfPhysics(): number {
  const [changes, setChanges] = useState(0);
  useEffect(
    () =>
      useStudio.subscribe((now, before) => {
        if (keyOf(now.state?.physics) !== keyOf(before.state?.physics)) setChanges((count) => count + 1);
      }),
    [],
  );
  return changes;
}

/**
 * Drive the robot while the view is open: keys, sticks and gamepads together set the twist. Another `attempt` starts it
 * anew.
 */
export function useDriving(settings: Settings, attempt: number): Sticks {
  const pressed = useRef(new Set<string>());
  const sticks = useRef<Deflection>(CENTRED);
  const latest = useRef(settings);
  const robot = useStudio((studio) => studio.robot?.id);
  const open = useStudio((studio) => studio.link.kind === "open");
  const physics = useChangesOfPhysics();

  // A new session (after a broken connection), another robot and other physics have to be started. Before the first command is sent.
  useEffect(() => {
    if (!open) return;
    ask({ type: "drive", on: true });
    return () => ask({ type: "drive", on: false });
  }, [open, robot, physics, attempt]);

  useEffect(() => {
    latest.current = settings;
    if (open) ask(commandOf(sumOf([keyDeflection(pressed.current), sticks.current]), settings));
  }, [settings, open, robot, physics, attempt]);

  useEffect(() => {
    const keys = pressed.current;
    let centred = true;
    const send = () => {
      const pads = navigator
        .getGamepads()
        .flatMap((pad) => (pad?.mapping === "standard" ? [gamepadDeflection(pad.axes)] : []));
      const deflection = sumOf([keyDeflection(keys), sticks.current, ...pads]);
      // The command to stop is sent once.
      if (isCentred(deflection) && centred) return;
      centred = isCentred(deflection);
      ask(commandOf(deflection, latest.current));
    };
    const down = (event: KeyboardEvent) => {
      if (!isDriveKey(event.key) || event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target))
        return;
      // Arrow keys belong to the slider, the tab or the stick that has the focus, and with Shift to the camera.
      if (
        event.key.startsWith("Arrow") &&
        (event.defaultPrevented || event.shiftKey || isChoosing(event.target))
      )
        return;
      event.preventDefault();
      keys.add(event.key.toLowerCase());
    };
    const up = (event: KeyboardEvent) => void keys.delete(event.key.toLowerCase());
    // The page gets no event for a key that is released in another window.
    const release = () => keys.clear();
    const timer = window.setInterval(send, INTERVAL);
    window.addEventListener("keydown", down);
    window.addEventListener("keyup", up);
    window.addEventListener("blur", release);
    return () => {
      window.clearInterval(timer);
      window.removeEventListener("keydown", down);
      window.removeEventListener("keyup", up);
      window.removeEventListener("blur", release);
      keys.clear();
    };
  }, []);

  return {
    walk: (x, y) => (sticks.current = { ...sticks.current, forward: y, left: -x }),
    turn: (x) => (sticks.current = { ...sticks.current, turn: -x }),
  };
}

function commandOf(
  deflection: Deflection,
  { speed, turn, gait, bodyHeight, swingHeight, body, state }: Settings,
): Omit<Command, "id"> {
  return {
    type: "command",
    velocity_mm_s: [deflection.forward * speed, deflection.left * speed],
    turn_deg_s: deflection.turn * turn,
    gait,
    body_height_mm: bodyHeight,
    swing_height_mm: swingHeight,
    body: body && [...body],
    state,
  };
}

/** Whether arrow keys change an input that has the focus: a slider or one of several choices. */
function isChoosing(target: EventTarget | null): boolean {
  return target instanceof HTMLInputElement && (target.type === "range" || target.type === "radio");
}
