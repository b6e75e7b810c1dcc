import type { StudioState } from "../protocol";
import type { ClientType, Draft } from "./outbox";

/** Parts of the state that are set by a message of the same name. */
export type Settable = "joints" | "body" | "walk" | "physics" | "loads" | "source";
const SETTABLE: ReadonlySet<string> = new Set<Settable>([
  "joints",
  "body",
  "walk",
  "physics",
  "loads",
  "source",
]);

export function isSettable(type: ClientType): type is Settable {
  return SETTABLE.has(type);
}

/**
 * Changes that the text of the state does not contain yet: sent but not answered, made during the movement of a
 * slider, or without a connection. They are sent to a new session.
 */
export class Unsaved {
  private readonly drafts = new Map<Settable, Draft>();

  add(draft: Draft): void {
    if (isSettable(draft.type)) this.drafts.set(draft.type, draft);
  }

  /** The text of the state contains this part now. */
  kept(type: ClientType): void {
    if (isSettable(type)) this.drafts.delete(type);
  }

  /** The state has been replaced. */
  forget(): void {
    this.drafts.clear();
  }

  /** The messages for a new session, each with a commit, as no movement is in progress. */
  take(): Draft[] {
    const all = [...this.drafts.values()].map((draft) => ({ ...draft, commit: true }) as Draft);
    this.drafts.clear();
    return all;
  }
}

/** The state after a message. */
export function withPart(state: StudioState, draft: Draft): StudioState {
  return isSettable(draft.type)
    ? { ...state, [draft.type]: (draft as unknown as StudioState)[draft.type] }
    : state;
}

/** Whether the refusal of a robot file is out of date with a message: another change is made, whatever comes of it. */
export function endsFileRefusal(draft: Draft): boolean {
  return "commit" in draft || draft.type === "undo" || draft.type === "redo" || draft.type === "robot";
}
