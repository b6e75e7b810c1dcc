/** What the arrows and the bars of the loads mean. */
export function ForceLegend() {
  return (
    <ul className="force-legend" data-testid="force-legend">
      <li>
        <svg viewBox="0 0 14 16" width="14" height="16" aria-hidden="true">
          <path className="force" d="M7 0 11 6H8v10H6V6H3z" />
        </svg>
        Ground force on the foot [N]
      </li>
      <li>
        <svg viewBox="0 0 14 16" width="14" height="16" aria-hidden="true">
          <path className="frame" d="M4 .5h6v15H4z" />
          <path className="torque" d="M5 10h4v5H5z" />
        </svg>
        Torque; full bar: stall torque
      </li>
    </ul>
  );
}
