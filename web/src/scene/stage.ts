import { invalidate } from "@react-three/fiber";

import { blend, distance, type Frame } from "./frame";

/** Time in which the picture comes 63 % closer to where it should be [s]. */
const FOLLOWING = 0.03;
/** Closer than this, the picture is where it should be [mm]. */
const CLOSE = 0.05;

/**
 * What the canvas draws, kept outside React: 60 frames a second must not render a component.
 * Answers of the server are targets; what is drawn follows them within a few hundredths of a second.
 */
class Stage {
  current: Frame | null = null;
  private target: Frame | null = null;
  private clock: ((dt: number) => Frame | null) | null = null;
  private readonly watchers = new Set<(frame: Frame) => void>();

  /** Move to a frame, smoothly unless told otherwise. */
  show(frame: Frame, smooth = true): void {
    this.target = frame;
    if (!smooth || !this.current || prefersStillness()) this.current = frame;
    invalidate();
  }

  /** Let a clock give the frames from now on (a walk that plays), until it gives null; returns how to stop it. */
  play(clock: (dt: number) => Frame | null): () => void {
    this.clock = clock;
    invalidate();
    return () => {
      if (this.clock === clock) this.clock = null;
    };
  }

  /** Be told every frame that is drawn; returns how to stop. */
  watch(watcher: (frame: Frame) => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  /** Advance by dt [s] before a frame is drawn; returns whether another is needed. */
  advance(dt: number): boolean {
    const moving = this.follow(dt);
    const { current } = this;
    if (current) this.watchers.forEach((watcher) => watcher(current));
    return moving;
  }

  private follow(dt: number): boolean {
    const played = this.clock?.(dt);
    if (played) {
      this.current = this.target = played;
      return true;
    }
    const { current, target } = this;
    if (!current || !target || current === target) return false;
    const next = blend(current, target, 1 - Math.exp(-dt / FOLLOWING));
    this.current = distance(next, target) < CLOSE ? target : next;
    return true;
  }
}

export function prefersStillness(): boolean {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}

export const stage = new Stage();
