import { create } from "zustand";

import type {
  BringUpMessage,
  CalibrationMessage,
  DriveFrame,
  ErrorMessage,
  LoadsMessage,
  PoseMessage,
  RobotMessage,
  ServosMessage,
  SimulatedMessage,
  SourceMessage,
  StudioState,
  TerrainMessage,
  WalkMessage,
  Welcome,
  WorkspaceMessage,
} from "../protocol";
import type { LinkStatus } from "./link";
import type { ClientType } from "./outbox";

export type View = StudioState["view"];

/** State of the page. Frames at 60 Hz are in the stage instead. */
export interface Studio {
  link: LinkStatus;
  welcome: Welcome | null;
  robot: RobotMessage | null;
  /** Inputs of the user; ahead of the server's while a message is in flight. */
  state: StudioState | null;
  /** State of the server as the text of a link. */
  stateText: string | null;
  undo: boolean;
  redo: boolean;
  poses: Partial<Record<View, PoseMessage>>;
  walk: WalkMessage | null;
  /** Loads of that walk; null where they are not computed yet. */
  loads: LoadsMessage | null;
  /** That walk in physics; null where it is not simulated yet. */
  simulated: SimulatedMessage | null;
  /** The terrain of physics; null where physics has not been on. */
  terrain: TerrainMessage | null;
  servos: ServosMessage | null;
  workspace: WorkspaceMessage | null;
  source: SourceMessage | null;
  /** A recent frame of the driven robot, for the panel; the 3D view has its own. */
  drive: DriveFrame | null;
  /** The bring-up of the servos; null without one. */
  bringUp: BringUpMessage | null;
  /** The calibration whose pulses are shown; null before one was loaded. */
  calibration: CalibrationMessage | null;
  /** Errors by the type of the request; removed when a request of the type succeeds. */
  failures: Partial<Record<ClientType, ErrorMessage>>;
  /** The input of each type that was changed last, such as stroke_mm. */
  edited: Partial<Record<ClientType, string>>;
  /** Types with a request in progress. */
  busy: Partial<Record<ClientType, boolean>>;
  /** A notification that disappears by itself. */
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
  simulated: null,
  terrain: null,
  servos: null,
  workspace: null,
  source: null,
  drive: null,
  bringUp: null,
  calibration: null,
  failures: {},
  edited: {},
  busy: {},
  notice: null,
}));

/** Show a notification. */
export function notify(text: string): void {
  useStudio.setState((studio) => ({ notice: { text, key: (studio.notice?.key ?? 0) + 1 } }));
}
