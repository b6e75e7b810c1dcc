import { Icon } from "../controls/icons";
import { fixed, withUnit } from "../controls/numbers";
import type { CalibrationMessage } from "../protocol";
import { copyText } from "../state/copyLink";
import { Message } from "../controls/Message";
import { useStudio } from "../state/store";
import { angleText, JOINTS } from "./angleText";
import { beyondTexts, pulseOf, pulseTable } from "./pulses";

interface Props {
  codes: readonly string[];
  /** Legs x (coxa, femur, tibia) [deg]. */
  angles: ArrayLike<number>;
  /** The same as measured, null for joints without; left out where nothing is. */
  measured?: readonly (number | null)[];
  open?: boolean;
  /** Time of the angles [s]. */
  at?: number;
}

/** Table of the joint angles, with a button to copy it. */
export function AngleTable({ codes, angles, measured, open, at }: Props) {
  const loaded = useStudio((studio) => studio.calibration);
  const calibration = loaded?.unit.length === codes.length * JOINTS.length ? loaded : null;
  const beyond = calibration ? beyondTexts(codes, calibration, angles) : [];
  return (
    <details open={open}>
      <summary>{at === undefined ? "Joint angles" : `Joint angles at ${fixed(at, 2)} s`}</summary>
      <div className="inside">
        <table data-testid="angles">
          <caption className={measured ? undefined : "hidden-text"}>
            Joint angles in degrees{measured && ", measured ones in brackets"}
          </caption>
          <thead>
            <tr>
              <th scope="col">Leg</th>
              {JOINTS.map((joint) => (
                <th key={joint} scope="col">
                  {joint} °
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {codes.map((code, leg) => (
              <tr key={code}>
                <th scope="row">{code}</th>
                {JOINTS.map((joint, i) => (
                  <td key={joint}>
                    {fixed(angles[leg * 3 + i] ?? 0, 2)}
                    {measured && ` (${withUnit(measured[leg * 3 + i] ?? null, 1, "")})`}
                    {calibration && (
                      <Pulse calibration={calibration} joint={leg * 3 + i} angle={angles[leg * 3 + i] ?? 0} />
                    )}
                  </td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
        <div className="row">
          <button
            type="button"
            className="button small"
            data-testid="copy-angles"
            onClick={() => void copyText(angleText(codes, angles), "Angles copied")}
          >
            <Icon name="copy" /> Copy
          </button>
          {calibration && (
            <button
              type="button"
              className="button small"
              data-testid="copy-pulses"
              disabled={beyond.length > 0}
              onClick={() => void copyText(pulseTable(codes, calibration, angles), "Pulses copied")}
            >
              <Icon name="copy" /> Copy pulses
            </button>
          )}
        </div>
        {beyond.length > 0 && (
          <Message kind="bad" testId="pulses-beyond">
            <span className="lines">{beyond.join("\n")}</span>
          </Message>
        )}
      </div>
    </details>
  );
}

interface PulseProps {
  calibration: CalibrationMessage;
  joint: number;
  angle: number;
}

function Pulse({ calibration, joint, angle }: PulseProps) {
  const { command, beyond } = pulseOf(calibration, joint, angle);
  const unit = calibration.unit[joint] === "us" ? "µs" : "ticks";
  return (
    <span className={`pulse${beyond ? " beyond" : ""}`}>
      {beyond && (
        <>
          <span aria-hidden="true">⚠ </span>
          <span className="hidden-text">beyond its limits: </span>
        </>
      )}
      {command} {unit}
    </span>
  );
}
