import type { ClientMessage } from "../protocol";

export type ClientType = ClientMessage["type"];
type WithoutId<M> = M extends { id: number } ? Omit<M, "id"> : never;
/** A message that has not got its id yet. */
export type Draft = WithoutId<ClientMessage>;
export type DraftOf<T extends ClientType> = Extract<Draft, { type: T }>;

/** Of these every one counts; of all others only the newest. */
const EVERY: ReadonlySet<ClientType> = new Set(["undo", "redo", "download"]);
/** These are waited for by nobody. */
const ALONE: ReadonlySet<ClientType> = new Set(["ping", "hello"]);
/** No type is sent more often than this [ms]: a screen shows no more. */
const SPACING = 15;

/**
 * What waits to be sent: of each type at most one message is under way, and of those that wait the newest wins.
 *
 * So a slider that moves faster than the server answers never builds a queue.
 */
export class Outbox {
  private next = 1;
  private readonly waiting = new Map<ClientType, Draft[]>();
  private readonly underWay = new Map<number, ClientType>();
  private readonly sentAt = new Map<ClientType, number>();

  constructor(private readonly send: (message: ClientMessage) => boolean) {}

  /** Add a message. */
  put(draft: Draft): void {
    const queue = this.waiting.get(draft.type) ?? [];
    const last = queue.at(-1);
    if (last && !EVERY.has(draft.type)) queue[queue.length - 1] = merged(last, draft);
    else queue.push(draft);
    this.waiting.set(draft.type, queue);
  }

  /** Send what may be sent at a time [ms]; returns after how many ms to try again, or null where nothing waits. */
  pump(now: number): number | null {
    let wait: number | null = null;
    for (const [type, queue] of this.waiting) {
      if (queue.length === 0 || this.isUnderWay(type)) continue;
      const left = SPACING - (now - (this.sentAt.get(type) ?? -Infinity));
      if (left > 0) {
        wait = Math.min(wait ?? Infinity, left);
        continue;
      }
      const draft = queue[0];
      const id = this.next;
      if (!draft || !this.send({ ...draft, id })) continue;
      this.next += 1;
      queue.shift();
      this.sentAt.set(type, now);
      if (!ALONE.has(type)) this.underWay.set(id, type);
      if (queue.length > 0) wait ??= SPACING;
    }
    return wait;
  }

  /** A message has been answered; returns of which type it was, or null where it is unknown. */
  settle(id: number): ClientType | null {
    const type = this.underWay.get(id) ?? null;
    this.underWay.delete(id);
    return type;
  }

  /** Of which type the message with an id is, while it is under way. */
  typeOf(id: number): ClientType | null {
    return this.underWay.get(id) ?? null;
  }

  /** Whether a message of a type is under way, or waits to be. */
  isBusy(type: ClientType): boolean {
    return this.isUnderWay(type) || (this.waiting.get(type)?.length ?? 0) > 0;
  }

  /** Whether a message of a type was sent after the one with an id, or waits to be. */
  isNewer(type: ClientType, id: number): boolean {
    const later = [...this.underWay].some(([sent, of]) => of === type && sent > id);
    return later || (this.waiting.get(type)?.length ?? 0) > 0;
  }

  private isUnderWay(type: ClientType): boolean {
    return [...this.underWay.values()].includes(type);
  }

  /** The connection is gone: nothing is under way any more, and what waits is told anew by the state. */
  reset(): void {
    this.waiting.clear();
    this.underWay.clear();
    this.sentAt.clear();
  }
}

/** The newer message, that is a step of undo if either is. */
function merged(older: Draft, newer: Draft): Draft {
  if ("commit" in older && "commit" in newer)
    return { ...newer, commit: (older.commit ?? true) || (newer.commit ?? true) };
  return newer;
}
