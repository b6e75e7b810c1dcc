import type { Equation } from "../../protocol";
import { valueText } from "./digits";
import { Maths } from "./Maths";

/** Given quantities of a document: symbol, quantity, and value for this robot. */
export function Givens({ equations }: { equations: readonly Equation[] }) {
  if (equations.length === 0) return null;
  return (
    <table className="givens">
      <caption>Given</caption>
      <thead className="hidden-text">
        <tr>
          <th scope="col">Symbol</th>
          <th scope="col">Quantity</th>
          <th scope="col">Value</th>
        </tr>
      </thead>
      <tbody>
        {equations.map(({ key, symbol, name, ours, value, unit }) => (
          <tr key={key} data-testid={`equation-${key}`}>
            <td>
              <Maths node={symbol} />
            </td>
            <td className="wrap">
              {name}
              {ours && <span className="hint"> – {ours}</span>}
            </td>
            <td>{valueText(value, unit)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
