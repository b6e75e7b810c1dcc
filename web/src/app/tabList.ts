import type { View } from "../state/store";

/** The seven views, in the order of their tabs. */
export const TABS: readonly { view: View; label: string }[] = [
  { view: "joints", label: "Joints" },
  { view: "body", label: "Body" },
  { view: "walk", label: "Walk" },
  { view: "drive", label: "Drive" },
  { view: "loads", label: "Loads" },
  { view: "robot", label: "Robot" },
  { view: "sources", label: "Sources" },
];
