import { create } from "zustand";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4] as const;

/** Time and settings of the playback. */
export interface Playback {
  time: number;
  playing: boolean;
  speed: number;
  loop: boolean;
}

export const usePlayback = create<Playback>(() => ({ time: 0, playing: false, speed: 1, loop: true }));

/** Playback after dt [s], of a walk that lasts `duration` [s]. */
export function advanced(playback: Playback, dt: number, duration: number): Playback {
  const time = playback.time + dt * playback.speed;
  if (time < duration) return { ...playback, time };
  return playback.loop && duration > 0
    ? { ...playback, time: time % duration }
    : { ...playback, time: duration, playing: false };
}

/** Time of the next or previous sample of the walk. */
export function stepped(time: number, direction: 1 | -1, rate: number, duration: number): number {
  const sample = direction > 0 ? Math.floor(time * rate + 1e-6) + 1 : Math.ceil(time * rate - 1e-6) - 1;
  return Math.min(duration, Math.max(0, sample / rate));
}
