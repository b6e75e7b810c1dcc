import { CLOSED, type ClientMessage, type ServerMessage } from "../protocol";
import { socketAddress } from "./address";
import { backoff } from "./backoff";
import { Outbox, type ClientType, type Draft } from "./outbox";

export type LinkStatus =
  | { kind: "connecting" }
  | { kind: "open" }
  | { kind: "lost"; text: string; attempt: number }
  /** Ended after a time without messages; reconnects at the next input. */
  | { kind: "asleep"; text: string }
  | { kind: "refused"; text: string };

export interface LinkEvents {
  status: (status: LinkStatus) => void;
  /** A message of the server, with the type of the request that it answers, where known. */
  message: (message: ServerMessage, asked: ClientType | null) => void;
  /** State to restore after a lost connection. */
  state: () => string | null;
}

/** Reasons not to reconnect. */
const FINAL: Partial<Record<number, string>> = {
  [CLOSED.TOKEN]: "A token is required: open the link that the server printed.",
};
const REASONS: Partial<Record<number, string>> = {
  [CLOSED.RATE]: "Too many messages were sent to the server.",
  [CLOSED.FULL]: "The server has reached its number of sessions.",
  [CLOSED.LARGE]: "The last message was too large for the server.",
};

/** Connection to the server: sends the state at the start, sends queued messages, reconnects by itself. */
export class Link {
  private socket: WebSocket | null = null;
  private attempt = 0;
  private timer: number | undefined;
  private pumping: number | undefined;
  private readonly outbox = new Outbox((message) => this.write(message));

  constructor(private readonly events: LinkEvents) {}

  open(): void {
    window.clearTimeout(this.timer);
    if (this.attempt === 0) this.events.status({ kind: "connecting" });
    const socket = new WebSocket(socketAddress(window.location.href));
    this.socket = socket;
    socket.onopen = () => {
      this.outbox.put({ type: "hello", state: this.events.state() });
      this.pump();
      this.events.status({ kind: "open" });
    };
    socket.onmessage = (event: MessageEvent<string>) => this.receive(JSON.parse(event.data) as ServerMessage);
    socket.onclose = (event) => this.closed(event.code);
  }

  /** Queue a message; returns whether there is a connection. */
  send(draft: Draft): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.outbox.put(draft);
    this.pump();
    return true;
  }

  isBusy(type: ClientType): boolean {
    return this.outbox.isBusy(type);
  }

  isNewer(type: ClientType, id: number): boolean {
    return this.outbox.isNewer(type, id);
  }

  private receive(message: ServerMessage): void {
    this.attempt = 0;
    const id = message.id;
    const asked = id === null ? null : this.outbox.typeOf(id);
    if (id !== null && message.type === "done") this.outbox.settle(id);
    this.events.message(message, asked);
    this.pump();
  }

  private closed(code: number): void {
    this.outbox.reset();
    this.socket = null;
    const final = FINAL[code];
    if (final) {
      this.events.status({ kind: "refused", text: final });
      return;
    }
    if (code === CLOSED.IDLE) {
      // Reconnecting here would keep an unused session open.
      this.events.status({ kind: "asleep", text: "The session has ended after a long time without input." });
      return;
    }
    const text = REASONS[code] ?? "The connection to the server is lost.";
    this.events.status({ kind: "lost", text, attempt: this.attempt });
    this.timer = window.setTimeout(() => this.open(), backoff(this.attempt));
    this.attempt += 1;
  }

  /** Reconnect immediately. */
  retry(): void {
    if (this.socket) return;
    this.attempt = 0;
    this.open();
  }

  private write(message: ClientMessage): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  private pump(): void {
    window.clearTimeout(this.pumping);
    const wait = this.outbox.pump(performance.now());
    if (wait !== null) this.pumping = window.setTimeout(() => this.pump(), wait);
  }
}
