import type { StudioState } from "../protocol";
import type { ClientType, Draft } from "./outbox";

/** The parts of the state that are set by a message of their own name. */
export type Settable = "joints" | "body" | "walk" | "loads" | "source";
const SETTABLE: ReadonlySet<string> = new Set<Settable>(["joints", "body", "walk", "loads", "source"]);

export function isSettable(type: ClientType): type is Settable {
  return SETTABLE.has(type);
}

/**
 * What the visitor has set that is not in the state's text yet: as it was sent without an answer, while a slider
 * moved, or without a connection. A new session hears of it.
 */
export class Unkept {
  private readonly drafts = new Map<Settable, Draft>();

  add(draft: Draft): void {
    if (isSettable(draft.type)) this.drafts.set(draft.type, draft);
  }

  /** The state's text now holds it. */
  kept(type: ClientType): void {
    if (isSettable(type)) this.drafts.delete(type);
  }

  /** Another state has taken the place of all that was set. */
  forget(): void {
    this.drafts.clear();
  }

  /** What to tell a new session: steps of undo each, as nothing moves any more. */
  take(): Draft[] {
    const all = [...this.drafts.values()].map((draft) => ({ ...draft, commit: true }) as Draft);
    this.drafts.clear();
    return all;
  }
}

/** A state with the part that a message sets. */
export function withPart(state: StudioState, draft: Draft): StudioState {
  return isSettable(draft.type)
    ? { ...state, [draft.type]: (draft as unknown as StudioState)[draft.type] }
    : state;
}
