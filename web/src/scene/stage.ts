import { invalidate } from "@react-three/fiber";

import { blend, distance, type Frame } from "./frame";

/** Time constant of the smoothing [s]. */
const TIME_CONSTANT = 0.03;
/** Distance below which the target is reached [mm]. */
const TOLERANCE = 0.05;

/**
 * The frame that the canvas draws, kept outside React: 60 frames a second must not render components.
 * Answers of the server are targets, which the drawn frame follows with a short time constant.
 */
class Stage {
  current: Frame | null = null;
  private target: Frame | null = null;
  private clock: ((dt: number) => Frame | null) | null = null;
  private readonly targetWatchers = new Set<(frame: Frame) => void>();
  private readonly watchers = new Set<(frame: Frame) => void>();

  /** Set the target frame; without smoothing it is drawn immediately. */
  show(frame: Frame, smooth = true): void {
    this.target = frame;
    this.targetWatchers.forEach((watcher) => watcher(frame));
    if (!smooth || !this.current || prefersReducedMotion()) this.current = frame;
    invalidate();
  }

  /** Take frames from a clock (the playback of a walk) until it returns null; returns a function that stops it. */
  play(clock: (dt: number) => Frame | null): () => void {
    this.clock = clock;
    invalidate();
    return () => {
      if (this.clock === clock) this.clock = null;
    };
  }

  /** Call a function with every drawn frame; returns a function that stops this. */
  watch(watcher: (frame: Frame) => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  /** Call a function with every frame that is set as target; returns a function that stops this. */
  watchTargets(watcher: (frame: Frame) => void): () => void {
    this.targetWatchers.add(watcher);
    return () => this.targetWatchers.delete(watcher);
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
    const next = blend(current, target, 1 - Math.exp(-dt / TIME_CONSTANT));
    this.current = distance(next, target) < TOLERANCE ? target : next;
    return true;
  }
}

export function prefersReducedMotion(): boolean {
  return window.matchMedia("(prefers-reduced-motion: reduce)").matches;
}

export const stage = new Stage();
