import type { Command, DriveFrame } from "../../protocol";

export type RobotState = DriveFrame["state"];
/** A state that a command can request; walking follows from a twist. */
export type RequestedState = NonNullable<Command["state"]>;

/** The buttons that request a state. */
export const REQUESTS: readonly { state: RequestedState; label: string; hint: string }[] = [
  { state: "standing", label: "Stand up", hint: "Rise from the ground and stand" },
  { state: "lying", label: "Sit down", hint: "Lower the body to the ground" },
  { state: "folded", label: "Fold", hint: "Sit down and fold the legs" },
];

/** Whether a request for a state would change anything: folded legs are unfolded by standing up only. */
export function canRequest(
  state: RequestedState,
  requested: RequestedState | null,
  present: RobotState,
): boolean {
  return state !== (requested ?? present) && !(state === "lying" && present === "folded");
}

/** The state in words, with the walk state or the stage where they say more. */
export function stateText({ state, activity, guard }: DriveFrame): string {
  if (state === "fault") return `fault (guard: ${guard})`;
  return activity === state ? state : `${state}: ${activity}`;
}

/** A heading in words, such as 12° left. */
export function headingText(degrees: number): string {
  const rounded = Math.round(degrees);
  if (rounded === 0) return "0°";
  return `${Math.abs(rounded)}° ${rounded > 0 ? "left" : "right"}`;
}

/** Speed [mm/s] and heading [deg] in words: 85 mm/s, heading 12° left. */
export function motionText(speed: number, heading: number): string {
  return `${Math.round(speed)} mm/s, heading ${headingText(heading)}`;
}
