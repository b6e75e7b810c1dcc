import { Icon } from "../controls/icons";
import { fixed, withUnit } from "../controls/numbers";
import { copyText } from "../state/copyLink";
import { angleText, JOINTS } from "./angleText";

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
        </div>
      </div>
    </details>
  );
}
