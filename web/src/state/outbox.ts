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
/** These change nothing that others would have to come before or after. */
const FREE: ReadonlySet<ClientType> = new Set(["ping", "hello", "command", "zone"]);
/** No type is sent more often than this [ms]: a screen shows no more. */
const SPACING = 15;

/**
 * What waits to be sent: of each type at most one message is under way, and of those that wait the newest wins.
 *
 * So a slider that moves faster than the server answers never builds a queue. What decides something, as a slider
 * at rest or undo does, is never overtaken by another type, nor does it overtake any: else undo would undo another thing.
 */
export class Outbox {
  private next = 1;
  private readonly waiting = new Map<ClientType, Draft[]>();
  /** What goes before all that waits, in turn. */
  private readonly first: Draft[] = [];
  private readonly underWay = new Map<number, ClientType>();
  private readonly sentAt = new Map<ClientType, number>();

  constructor(private readonly send: (message: ClientMessage) => boolean) {}

  /** Add a message. */
  put(draft: Draft): void {
    if (!FREE.has(draft.type)) this.hurry(draft);
    const queue = this.waiting.get(draft.type) ?? [];
    const last = queue.at(-1);
    if (last && !EVERY.has(draft.type)) queue[queue.length - 1] = merged(last, draft);
    else queue.push(draft);
    this.waiting.set(draft.type, queue);
  }

  /** Let those of other types go before a message that must not overtake them, or be overtaken by it. */
  private hurry(draft: Draft): void {
    for (const [type, queue] of this.waiting) {
      if (type === draft.type || FREE.has(type)) continue;
      if (decides(draft) || queue.some(decides)) this.first.push(...queue.splice(0));
    }
  }

  /** Send what may be sent at a time [ms]; returns after how many ms to try again, or null where nothing waits. */
  pump(now: number): number | null {
    while (this.first[0] && this.sent(this.first[0], now)) this.first.shift();
    if (this.first.length > 0) return null;
    let wait: number | null = null;
    for (const [type, queue] of this.waiting) {
      if (queue.length === 0 || this.isUnderWay(type)) continue;
      const left = SPACING - (now - (this.sentAt.get(type) ?? -Infinity));
      if (left > 0) {
        wait = Math.min(wait ?? Infinity, left);
        continue;
      }
      if (!queue[0] || !this.sent(queue[0], now)) continue;
      queue.shift();
      if (queue.length > 0) wait ??= SPACING;
    }
    return wait;
  }

  private sent(draft: Draft, now: number): boolean {
    const id = this.next;
    if (!this.send({ ...draft, id })) return false;
    this.next += 1;
    this.sentAt.set(draft.type, now);
    if (!ALONE.has(draft.type)) this.underWay.set(id, draft.type);
    return true;
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
    return this.isUnderWay(type) || this.isWaiting(type);
  }

  /** Whether a message of a type was sent after the one with an id, or waits to be. */
  isNewer(type: ClientType, id: number): boolean {
    const later = [...this.underWay].some(([sent, of]) => of === type && sent > id);
    return later || this.isWaiting(type);
  }

  private isWaiting(type: ClientType): boolean {
    return (this.waiting.get(type)?.length ?? 0) > 0 || this.first.some((draft) => draft.type === type);
  }

  private isUnderWay(type: ClientType): boolean {
    return [...this.underWay.values()].includes(type);
  }

  /** The connection is gone: nothing is under way any more, and what waits is told anew by the state. */
  reset(): void {
    this.waiting.clear();
    this.first.length = 0;
    this.underWay.clear();
    this.sentAt.clear();
  }
}

/** Whether a message ends a change, rather than be followed by more of it. */
function decides(draft: Draft): boolean {
  return !("commit" in draft) || (draft.commit ?? true);
}

/** The newer message, that is a step of undo if either is. */
function merged(older: Draft, newer: Draft): Draft {
  if ("commit" in older && "commit" in newer)
    return { ...newer, commit: (older.commit ?? true) || (newer.commit ?? true) };
  return newer;
}
