import { CAMERAS, type CameraName } from "../scene/cameras";

interface Props {
  camera: CameraName;
  onChoose: (camera: CameraName) => void;
}

/** Where the picture is seen from. Pressing the one that is on goes back to its place. */
export function CameraBar({ camera, onChoose }: Props) {
  return (
    <div className="segments cameras" role="group" aria-label="Camera">
      {CAMERAS.map(({ name, label, hint }) => (
        <button
          key={name}
          type="button"
          className="segment"
          title={hint}
          aria-pressed={name === camera}
          data-testid={`camera-${name}`}
          onClick={() => onChoose(name)}
        >
          {label}
        </button>
      ))}
    </div>
  );
}
