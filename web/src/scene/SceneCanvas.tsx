import { Canvas, type ThreeEvent } from "@react-three/fiber";
import { PCFShadowMap } from "three";
import { useRef, type KeyboardEvent, type ReactNode } from "react";

import { Arrows } from "./Arrows";
import { CameraRig, type View } from "./CameraRig";
import type { CameraName, Place } from "./cameras";
import { FrameLoop } from "./FrameLoop";
import { Contacts } from "./Contacts";
import type { Shape } from "./frame";
import { FootTargets } from "./FootTargets";
import { Ground } from "./Ground";
import { Lights } from "./Lights";
import { LabelPositions } from "./LabelPositions";
import { Labels } from "./Labels";
import type { Palette } from "./palette";
import { SceneErrorBoundary } from "./SceneErrorBoundary";
import { Robot } from "./Robot";
import { steer } from "./cameraKeys";
import { Support } from "./Support";
import { TorqueBars } from "./TorqueBars";
import { Trails } from "./Trails";

export interface SceneProps {
  shape: Shape;
  colours: readonly string[];
  palette: Palette;
  camera: CameraName;
  view: View;
  place?: Place | null;
  trails?: readonly ArrayLike<number>[];
  forces?: boolean;
  torques?: boolean;
  /** Whether there is level ground at height 0. */
  ground?: boolean;
  /** Whether arrow keys drive the robot: then they turn the camera with Shift only. */
  driven?: boolean;
  /** Description for screen readers. */
  description: string;
  onRest?: (place: Place, turned: boolean) => void;
  /** Called on a click on the ground [mm]; left out where clicks have no effect. */
  onFloor?: (x: number, y: number) => void;
  children?: ReactNode;
}

const nothing = () => undefined;

/** The 3D view: one canvas shared by all views; also used by the player. */
export function SceneCanvas(props: SceneProps) {
  return (
    <SceneErrorBoundary>
      <Scene {...props} />
    </SceneErrorBoundary>
  );
}

function Scene(props: SceneProps) {
  const {
    shape,
    colours,
    palette,
    camera,
    view,
    place = null,
    trails,
    forces,
    torques,
    ground = true,
    driven,
    onFloor,
  } = props;
  const notes = useRef<HTMLDivElement>(null);
  const keys = (event: KeyboardEvent) => {
    if (driven && event.key.startsWith("Arrow") && !event.shiftKey) return;
    if (steer(event.key)) event.preventDefault();
  };
  return (
    // Focusable: arrow keys turn the camera, + and - zoom.
    // eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions
    <div
      className="scene"
      role="application"
      aria-roledescription="3D view"
      aria-label={`${props.description} ${driven ? "Shift and the arrow keys" : "Arrow keys"} turn the camera, plus and minus zoom.`}
      data-testid="scene"
      // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex
      tabIndex={0}
      onKeyDown={keys}
    >
      <Canvas
        frameloop="demand"
        shadows={{ type: PCFShadowMap }}
        dpr={[1, 2]}
        camera={{ fov: 32, near: 10, far: 20_000, up: [0, 0, 1], position: [-600, -500, 600] }}
        gl={{ antialias: true, preserveDrawingBuffer: true, powerPreference: "low-power" }}
      >
        <color attach="background" args={[palette.background]} />
        <fog attach="fog" args={[palette.background, view.radius * 6 + 1200, view.radius * 10 + 3600]} />
        <FrameLoop />
        <Lights palette={palette} reach={shape.reach} />
        {ground && <Ground palette={palette} />}
        {onFloor && (
          <mesh
            name="floor-pick"
            position={[0, 0, -1]}
            onClick={(event: ThreeEvent<MouseEvent>) =>
              event.delta < 4 && onFloor(event.point.x, event.point.y)
            }
          >
            <planeGeometry args={[20_000, 20_000]} />
            <meshBasicMaterial transparent opacity={0} depthWrite={false} />
          </mesh>
        )}
        <Support palette={palette} shape={shape} />
        <Contacts shape={shape} palette={palette} />
        {trails && <Trails paths={trails} colours={colours} />}
        <Robot shape={shape} colours={colours} palette={palette} />
        <FootTargets shape={shape} palette={palette} />
        {forces && <Arrows shape={shape} palette={palette} />}
        {torques && <TorqueBars shape={shape} palette={palette} />}
        {props.children}
        <CameraRig camera={camera} view={view} place={place} onRest={props.onRest ?? nothing} />
        <LabelPositions layer={notes} />
      </Canvas>
      <Labels layer={notes} shape={shape} colours={colours} forces={forces ?? false} />
    </div>
  );
}
