import { useRef } from "react";

import { FileInput } from "../controls/FileInput";
import { Message } from "../controls/Message";
import { ask } from "../state/session";
import { notify, useStudio } from "../state/store";
import { textOf } from "./robot/robotText";

/** Largest file that is read [bytes]. */
const LARGEST = 200_000;

/** Loads the calibration of a machine, whose pulses then stand beside the joint angles in all views. */
export function CalibrationFile() {
  const calibration = useStudio((studio) => studio.calibration);
  const input = useRef<HTMLInputElement>(null);
  const name = calibration?.name ?? null;
  return (
    <>
      <div className="row">
        <button
          type="button"
          className="button"
          data-testid="load-calibration"
          onClick={() => input.current?.click()}
        >
          Load calibration …
        </button>
        {name !== null && (
          <button
            type="button"
            className="button"
            data-testid="remove-calibration"
            onClick={() => ask({ type: "calibration", name: null, text: null })}
          >
            Remove {name}
          </button>
        )}
        <FileInput
          input={input}
          label="Calibration file to load"
          testId="calibration-file"
          onFile={(file) => void load(file)}
        />
      </div>
      {calibration?.problem != null && (
        <Message kind="warn" testId="calibration-problem">
          <span className="lines">No pulses are shown: {calibration.problem}</span>
        </Message>
      )}
    </>
  );
}

async function load(file: File): Promise<void> {
  if (file.size > LARGEST) {
    notify(`${file.name}: the file has ${file.size} bytes; at most ${LARGEST} are read`);
    return;
  }
  const found = textOf(new Uint8Array(await file.arrayBuffer()), "a calibration");
  if ("problem" in found) notify(`${file.name}: ${found.problem}`);
  else ask({ type: "calibration", name: file.name, text: found.text });
}
