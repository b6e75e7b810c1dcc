import { useEffect, useRef } from "react";

import { isTyping } from "../../app/useShortcuts";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { gamepadPush, isDriveKey, isStill, keyPush, STILL, sumOf, type Push } from "./push";

/** How often a wish is sent while something is pushed [ms]. */
const EVERY = 50;

/** Top speeds, and what is wished besides walking. */
export interface Settings {
  speed: number;
  turn: number;
  gait: string | null;
  bodyHeight: number | null;
  swingHeight: number | null;
  /** x, y, z [mm], roll, pitch, yaw [deg] over the level body. */
  body: readonly [number, number, number, number, number, number];
}

export interface Sticks {
  walk: (x: number, y: number) => void;
  turn: (x: number) => void;
}

/** Drive while the view is open: keys, sticks and gamepads together make the wish. */
export function useDriving(settings: Settings): Sticks {
  const held = useRef(new Set<string>());
  const sticks = useRef<Push>(STILL);
  const latest = useRef(settings);
  const robot = useStudio((studio) => studio.robot?.id);
  const open = useStudio((studio) => studio.link.kind === "open");

  useEffect(() => {
    latest.current = settings;
    if (open) ask(commandOf(sumOf([keyPush(held.current), sticks.current]), settings));
  }, [settings, open]);

  // Neither the session after a broken connection nor another robot drives yet.
  useEffect(() => {
    if (!open) return;
    ask({ type: "drive", on: true });
    return () => ask({ type: "drive", on: false });
  }, [open, robot]);

  useEffect(() => {
    const keys = held.current;
    let still = true;
    const send = () => {
      const pads = navigator
        .getGamepads()
        .flatMap((pad) => (pad?.mapping === "standard" ? [gamepadPush(pad.axes)] : []));
      const push = sumOf([keyPush(keys), sticks.current, ...pads]);
      // Standing still is said once.
      if (isStill(push) && still) return;
      still = isStill(push);
      ask(commandOf(push, latest.current));
    };
    const down = (event: KeyboardEvent) => {
      if (!isDriveKey(event.key) || event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target))
        return;
      event.preventDefault();
      keys.add(event.key.toLowerCase());
    };
    const up = (event: KeyboardEvent) => void keys.delete(event.key.toLowerCase());
    // A key that is let go elsewhere is never told.
    const release = () => keys.clear();
    const timer = window.setInterval(send, EVERY);
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

function commandOf(push: Push, { speed, turn, gait, bodyHeight, swingHeight, body }: Settings) {
  return {
    type: "command",
    velocity_mm_s: [push.forward * speed, push.left * speed] as [number, number],
    turn_deg_s: push.turn * turn,
    gait,
    body_height_mm: bodyHeight,
    swing_height_mm: swingHeight,
    body: [...body] as [number, number, number, number, number, number],
  } as const;
}
