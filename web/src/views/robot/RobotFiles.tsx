import { useEffect, useId, useRef, useState } from "react";

import { FileInput } from "../../controls/FileInput";
import { Icon } from "../../controls/icons";
import { useTouch } from "../../controls/useTouch";
import type { ErrorMessage } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { withValue } from "./document";
import { robotText } from "./robotText";
import { setDocument } from "./setDocument";

/** Name of the robot, and import and export of its file. */
export function RobotFiles() {
  const { robot } = useInputs();
  const id = useId();
  const input = useRef<HTMLInputElement>(null);
  const over = useDrop();
  const touch = useTouch();
  return (
    <div className={`drop${over ? " over" : ""}`}>
      <div className="field">
        <label htmlFor={id}>Name</label>
        <input
          id={id}
          type="text"
          data-testid="robot-name"
          key={robot.document.name}
          defaultValue={robot.document.name}
          maxLength={200}
          onBlur={(event) => {
            const name = event.target.value.trim();
            if (name && name !== robot.document.name) setDocument(withValue(robot.document, ["name"], name));
          }}
        />
      </div>
      <div className="row">
        <button
          type="button"
          className="button"
          data-testid="load-toml"
          onClick={() => input.current?.click()}
        >
          Import robot file …
        </button>
        <button
          type="button"
          className="button"
          data-testid="save-toml"
          onClick={() => ask({ type: "download", what: "toml" })}
        >
          <Icon name="save" /> Export robot file
        </button>
      </div>
      {!touch && <p className="hint">Or drop a .toml file anywhere on this page.</p>}
      <FileInput
        input={input}
        label="Robot file to import"
        testId="toml-file"
        onFile={(file) => void load(file)}
      />
    </div>
  );
}

/** Handle files dropped on the page; returns whether one is dragged over it. */
function useDrop(): boolean {
  const [over, setOver] = useState(false);
  useEffect(() => {
    const hold = (event: DragEvent) => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      setOver(true);
    };
    const leave = (event: DragEvent) => event.relatedTarget === null && setOver(false);
    const drop = (event: DragEvent) => {
      setOver(false);
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void load(file);
    };
    window.addEventListener("dragover", hold);
    window.addEventListener("dragleave", leave);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragover", hold);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("drop", drop);
    };
  }, []);
  return over;
}

async function load(file: File): Promise<void> {
  const most = Math.min(200_000, useStudio.getState().welcome?.bounds.message_bytes ?? 200_000);
  if (file.size > most) {
    refuse(`${file.name}: the file has ${file.size} bytes; at most ${most} are read`);
    return;
  }
  const found = robotText(new Uint8Array(await file.arrayBuffer()));
  if ("problem" in found) refuse(`${file.name}: ${found.problem}`);
  else ask({ type: "toml", text: found.text, commit: true });
}

/** Show why a file is not sent, where the server's refusals of files are shown. */
function refuse(text: string): void {
  const toml: ErrorMessage = {
    type: "error",
    id: null,
    kind: "robot_file",
    text,
    problems: [],
    longest_stroke_mm: null,
  };
  useStudio.setState((studio) => ({ failures: { ...studio.failures, toml } }));
}
