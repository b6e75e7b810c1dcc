import { Failure } from "../../controls/Failure";
import { Message } from "../../controls/Message";
import type { BringUpMessage } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { ViewHead } from "../ViewHead";
import { QuestionCard } from "./QuestionCard";

/** The way into the bring-up, or why there is none. */
export function BringUpOffer() {
  const missing = useStudio((studio) => studio.welcome?.hardware.missing ?? null);
  return (
    <>
      <p className="hint">
        Finds the servos of a new machine, and which joint each of them is; sets zeros and limits. One servo
        at a time moves a little, and you say what moved. The calibration file is saved after every answer.
        Emulated servos are there to try it.
      </p>
      {missing !== null && (
        <Message kind="plain" testId="no-hardware">
          {missing}
        </Message>
      )}
      <Failure of={["bring_up"]} />
      <div className="row">
        <button
          type="button"
          className="button"
          disabled={missing !== null}
          data-testid="bring-up"
          onClick={begin}
        >
          Bring up the servos
        </button>
      </div>
    </>
  );
}

function begin() {
  ask({ type: "bring_up", on: true });
}

/** The bring-up: what it says and asks, and how far it is. */
export function BringUpView({ bringUp }: { bringUp: BringUpMessage }) {
  const { state, question, said, known, joints, file, problem, emulated } = bringUp;
  const over = state !== "asking" && state !== "moving";
  return (
    <div className="view">
      <ViewHead title="Bring-up">
        {emulated
          ? "Emulated servos: the 3D view shows what they do, and hands hold the legs where you are asked to."
          : "Put the robot on a box, feet in the air. Look at the robot; the 3D view shows the reference pose."}
      </ViewHead>
      <Failure of={["bring_up", "answer"]} />
      <p>
        <label>
          <span data-testid="bring-up-known">
            {known} of {joints} joints are calibrated
          </span>{" "}
          <progress value={known} max={joints} />
        </label>
      </p>
      {question && <QuestionCard key={question.number} question={question} />}
      {state === "moving" && (
        <p role="status" data-testid="bring-up-moving">
          Working …
        </p>
      )}
      {over && <End state={state} file={file} problem={problem} />}
      <div role="log" aria-label="What was said" data-testid="bring-up-said">
        <ul className="log">
          {said.map((line, i) => (
            <li key={`${i} ${line}`}>{line}</li>
          ))}
        </ul>
      </div>
      {!over && (
        <>
          <div className="row">
            <button
              type="button"
              className="button"
              data-testid="bring-up-leave"
              onClick={() => ask({ type: "bring_up", on: false })}
            >
              Release the servos and leave
            </button>
          </div>
          <p className="hint">Saved after every answer in {file}; leave at any time, and go on later.</p>
        </>
      )}
    </div>
  );
}

interface EndProps {
  state: "done" | "left" | "failed";
  file: string;
  problem: string | null;
}

function End({ state, file, problem }: EndProps) {
  const close = () => useStudio.setState({ bringUp: null });
  return (
    <>
      <Message
        kind={state === "done" ? "good" : state === "failed" ? "bad" : "plain"}
        alert
        testId="bring-up-end"
      >
        {state === "done" &&
          `All joints are calibrated: ${file}. Next: tarsus run, with --calibration ${file}.`}
        {state === "left" && `Left; the servos are released. What was answered is saved in ${file}.`}
        {state === "failed" && <span className="lines">{problem}</span>}
      </Message>
      <div className="row">
        {state !== "done" && (
          <button type="button" className="button" data-testid="bring-up-again" onClick={begin}>
            Go on
          </button>
        )}
        <button type="button" className="button" data-testid="bring-up-close" onClick={close}>
          Back to the robot
        </button>
      </div>
    </>
  );
}
