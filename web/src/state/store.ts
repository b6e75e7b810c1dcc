import { create } from "zustand";

import type {
  DriveFrame,
  ErrorMessage,
  LoadsMessage,
  PoseMessage,
  RobotMessage,
  ServosMessage,
  SourceMessage,
  StudioState,
  WalkMessage,
  Welcome,
  ZoneMessage,
} from "../protocol";
import type { LinkStatus } from "./link";
import type { ClientType } from "./outbox";

export type View = StudioState["view"];

/** All that the page knows. What comes sixty times a second is not here but on the stage. */
export interface Studio {
  link: LinkStatus;
  welcome: Welcome | null;
  robot: RobotMessage | null;
  /** The visitor's inputs; ahead of the server's while a message is under way. */
  state: StudioState | null;
  /** The same as the server's short text. */
  stateText: string | null;
  undo: boolean;
  redo: boolean;
  poses: Partial<Record<View, PoseMessage>>;
  walk: WalkMessage | null;
  /** Of that walk; null where it was not worked out yet. */
  loads: LoadsMessage | null;
  servos: ServosMessage | null;
  zone: ZoneMessage | null;
  source: SourceMessage | null;
  /** The live walker, a few times a second: for words and numbers, not for the picture. */
  drive: DriveFrame | null;
  /** What was refused, by the type of the question; gone when the same is asked with success. */
  failures: Partial<Record<ClientType, ErrorMessage>>;
  /** What is being worked on. */
  busy: Partial<Record<ClientType, boolean>>;
  /** A short message that passes, for eyes and screen readers. */
  notice: { text: string; key: number } | null;
}

export const useStudio = create<Studio>(() => ({
  link: { kind: "connecting" },
  welcome: null,
  robot: null,
  state: null,
  stateText: null,
  undo: false,
  redo: false,
  poses: {},
  walk: null,
  loads: null,
  servos: null,
  zone: null,
  source: null,
  drive: null,
  failures: {},
  busy: {},
  notice: null,
}));

/** Say something in passing. */
export function notify(text: string): void {
  useStudio.setState((studio) => ({ notice: { text, key: (studio.notice?.key ?? 0) + 1 } }));
}
