import { IconButton } from "../controls/IconButton";
import { Select } from "../controls/Select";
import { savePng } from "../scene/png";
import { ask, look } from "../state/session";
import { copyLink } from "../state/copyLink";
import { useStudio } from "../state/store";
import { toggleTheme, useTheme } from "./theme";

/** Choice of the robot, undo and redo, and export of link and picture. */
export function Header() {
  const theme = useTheme((state) => state.theme);
  const undo = useStudio((studio) => studio.undo);
  const redo = useStudio((studio) => studio.redo);
  return (
    <header className="header">
      <h1 className="brand">
        <img src="./icon.svg" alt="" />
        <span>Tarsus Studio</span>
      </h1>
      <RobotChoice />
      <div className="spring" />
      <IconButton
        icon="undo"
        name="Undo (Ctrl+Z)"
        testId="undo"
        disabled={!undo}
        onClick={() => ask({ type: "undo" })}
      />
      <IconButton
        icon="redo"
        name="Redo (Ctrl+Y)"
        testId="redo"
        disabled={!redo}
        onClick={() => ask({ type: "redo" })}
      />
      <IconButton
        icon="link"
        name="Copy a link to this state"
        testId="copy-link"
        onClick={() => void copyLink()}
      />
      <IconButton
        icon="camera"
        name="Save the 3D view as PNG"
        testId="save-png"
        onClick={() => void savePng()}
      />
      <IconButton
        icon={theme === "dark" ? "sun" : "moon"}
        name={theme === "dark" ? "Light colours" : "Dark colours"}
        testId="theme"
        onClick={toggleTheme}
      />
    </header>
  );
}

function RobotChoice() {
  const robots = useStudio((studio) => studio.welcome?.robots);
  const robot = useStudio((studio) => studio.robot);
  const runs = useStudio((studio) => studio.welcome?.run != null);
  if (!robots || !robot) return null;
  if (runs) return <span data-testid="run-robot">{robot.name}</span>;
  const options = robots.map((name) => ({ value: name, label: name }));
  const own = robot.preset === null ? [{ value: "", label: `${robot.name} (custom)` }] : [];
  return (
    <Select
      label="Robot"
      quiet
      testId="robot-choice"
      value={robot.preset ?? ""}
      options={[...own, ...options]}
      onChange={(preset) => preset && selectPreset(preset)}
    />
  );
}

/** Select a preset and reset the camera, as robots differ in size. */
function selectPreset(preset: string) {
  ask({ type: "robot", preset });
  look(null, { eye_mm: null, target_mm: null });
}
