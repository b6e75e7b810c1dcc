import { CLOSED, type ClientMessage, type ServerMessage } from "../protocol";
import { socketAddress } from "./address";
import { backoff } from "./backoff";
import { Outbox, type ClientType, type Draft } from "./outbox";

export type LinkStatus =
  | { kind: "connecting" }
  | { kind: "open" }
  | { kind: "lost"; text: string; attempt: number }
  /** Ended as nobody was there; comes back when somebody is. */
  | { kind: "asleep"; text: string }
  | { kind: "refused"; text: string };

export interface LinkEvents {
  status: (status: LinkStatus) => void;
  /** An answer, with the type of the question where it is known. */
  message: (message: ServerMessage, asked: ClientType | null) => void;
  /** The state to go on with after the connection broke. */
  state: () => string | null;
}

/** Why no further try makes sense. */
const FINAL: Partial<Record<number, string>> = {
  [CLOSED.TOKEN]:
    "This page needs the token of the server's link: open it by the link that the server printed.",
};
const REASONS: Partial<Record<number, string>> = {
  [CLOSED.RATE]: "The server was asked too much at once.",
  [CLOSED.FULL]: "The server has as many visitors as it takes.",
  [CLOSED.LARGE]: "The last message was too large for the server.",
};

/** The connection to the server: says hello with the state, sends what waits, comes back by itself. */
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

  /** Send a message, now or soon; returns whether there is a connection to send it by. */
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
      // To connect again by itself would keep a session that nobody uses.
      this.events.status({ kind: "asleep", text: "The session has ended, as nothing was done for long." });
      return;
    }
    const text = REASONS[code] ?? "The connection to the server is broken.";
    this.events.status({ kind: "lost", text, attempt: this.attempt });
    this.timer = window.setTimeout(() => this.open(), backoff(this.attempt));
    this.attempt += 1;
  }

  /** Try at once, as the visitor is there and waits. */
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
