import type { ClientMessage } from "../protocol";

export type ClientType = ClientMessage["type"];
type WithoutId<M> = M extends { id: number } ? Omit<M, "id"> : never;
/** A message without its id. */
export type Draft = WithoutId<ClientMessage>;
export type DraftOf<T extends ClientType> = Extract<Draft, { type: T }>;

/** Types of which every message is sent; of the others only the newest. */
const NEVER_MERGED: ReadonlySet<ClientType> = new Set(["undo", "redo", "download"]);
/** Types whose answers need not be awaited. */
const UNTRACKED: ReadonlySet<ClientType> = new Set(["ping", "hello"]);
/** Types whose order relative to others does not matter. */
const UNORDERED: ReadonlySet<ClientType> = new Set(["ping", "hello", "command", "workspace"]);
/** Minimum interval between messages of a type [ms]: about one frame of the display. */
const MIN_INTERVAL = 15;

/**
 * Queue of outgoing messages: of each type at most one is in flight, and only the newest of the others is kept.
 *
 * So a slider that changes faster than the server answers never builds up a queue. Messages with a commit, and undo,
 * keep their order relative to all other types, as undo would otherwise revert another change.
 */
export class Outbox {
  private next = 1;
  private readonly queued = new Map<ClientType, Draft[]>();
  /** Messages to be sent before all others, in order. */
  private readonly first: Draft[] = [];
  private readonly inFlight = new Map<number, ClientType>();
  private readonly sentAt = new Map<ClientType, number>();

  constructor(private readonly send: (message: ClientMessage) => boolean) {}

  /** Add a message. */
  put(draft: Draft): void {
    if (!UNORDERED.has(draft.type)) this.prioritise(draft);
    const queue = this.queued.get(draft.type) ?? [];
    const last = queue.at(-1);
    if (last && !NEVER_MERGED.has(draft.type)) queue[queue.length - 1] = merged(last, draft);
    else queue.push(draft);
    this.queued.set(draft.type, queue);
  }

  /** Move queued messages of other types to the front if their order relative to this message matters. */
  private prioritise(draft: Draft): void {
    for (const [type, queue] of this.queued) {
      if (type === draft.type || UNORDERED.has(type)) continue;
      if (isComplete(draft) || queue.some(isComplete)) this.first.push(...queue.splice(0));
    }
  }

  /** Send what may be sent at a time [ms]; returns the delay until the next attempt [ms], or null if none is needed. */
  pump(now: number): number | null {
    while (this.first[0] && this.sent(this.first[0], now)) this.first.shift();
    if (this.first.length > 0) return null;
    let wait: number | null = null;
    for (const [type, queue] of this.queued) {
      if (queue.length === 0 || this.isInFlight(type)) continue;
      const left = MIN_INTERVAL - (now - (this.sentAt.get(type) ?? -Infinity));
      if (left > 0) {
        wait = Math.min(wait ?? Infinity, left);
        continue;
      }
      if (!queue[0] || !this.sent(queue[0], now)) continue;
      queue.shift();
      if (queue.length > 0) wait ??= MIN_INTERVAL;
    }
    return wait;
  }

  private sent(draft: Draft, now: number): boolean {
    const id = this.next;
    if (!this.send({ ...draft, id })) return false;
    this.next += 1;
    this.sentAt.set(draft.type, now);
    if (!UNTRACKED.has(draft.type)) this.inFlight.set(id, draft.type);
    return true;
  }

  /** Mark a message as answered; returns its type, or null if it is unknown. */
  settle(id: number): ClientType | null {
    const type = this.inFlight.get(id) ?? null;
    this.inFlight.delete(id);
    return type;
  }

  /** Type of a message in flight. */
  typeOf(id: number): ClientType | null {
    return this.inFlight.get(id) ?? null;
  }

  /** Whether a message of a type is in flight or queued. */
  isBusy(type: ClientType): boolean {
    return this.isInFlight(type) || this.isQueued(type);
  }

  /** Whether a message of a type was sent after the one with an id, or is queued. */
  isNewer(type: ClientType, id: number): boolean {
    const later = [...this.inFlight].some(([sent, of]) => of === type && sent > id);
    return later || this.isQueued(type);
  }

  private isQueued(type: ClientType): boolean {
    return (this.queued.get(type)?.length ?? 0) > 0 || this.first.some((draft) => draft.type === type);
  }

  private isInFlight(type: ClientType): boolean {
    return [...this.inFlight.values()].includes(type);
  }

  /** Forget all messages after a lost connection: the state that is sent next replaces them. */
  reset(): void {
    this.queued.clear();
    this.first.length = 0;
    this.inFlight.clear();
    this.sentAt.clear();
  }
}

/** Whether a message completes a change: it has a commit, or is not part of a sequence. */
function isComplete(draft: Draft): boolean {
  return !("commit" in draft) || (draft.commit ?? true);
}

/** The newer message, with a commit if either has one. */
function merged(older: Draft, newer: Draft): Draft {
  if ("commit" in older && "commit" in newer)
    return { ...newer, commit: (older.commit ?? true) || (newer.commit ?? true) };
  return newer;
}
