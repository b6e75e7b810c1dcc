import { withUnit } from "../../controls/numbers";
import type { Erratum } from "../../protocol";
import { Maths } from "./Maths";

/** An erratum: printed and corrected formula, and the results of both. */
export function ErratumCard({ erratum }: { erratum: Erratum }) {
  const { unit } = erratum;
  return (
    <div className="equation">
      <dl className="erratum">
        <dt>As printed</dt>
        <dd className="scroll">
          {erratum.printed_formula ? <Maths node={erratum.printed_formula} block /> : erratum.printed}
          {erratum.printed_value !== null && <output>{withUnit(erratum.printed_value, 2, unit)}</output>}
        </dd>
        <dt>Corrected</dt>
        <dd className="scroll">
          {erratum.right_formula ? <Maths node={erratum.right_formula} block /> : erratum.right}
          {erratum.right_value !== null && <output>{withUnit(erratum.right_value, 2, unit)}</output>}
        </dd>
      </dl>
      <p className="hint">{erratum.why}</p>
    </div>
  );
}
