// Written by `make protocol` from src/tarsus/studio/messages. Change that, not this.

/** Path of the socket on the page's own host. */
export const SOCKET = "/session/1";

/** Codes with which the server closes the socket. */
export const CLOSED = {
  /** Wrong token, or none: the page must be opened by the link that the server printed. */
  TOKEN: 4401,
  /** Nothing was said for too long. To connect again is fine. */
  IDLE: 4408,
  /** Too many messages, or malformed ones, one after the other. */
  RATE: 4429,
  /** The server has as many sessions as it takes. To try again later is fine. */
  FULL: 4503,
  /** A message was larger than `bounds.message_bytes`. */
  LARGE: 1009,
} as const;

/** The view Body: how far the body is moved and turned over its feet, and where those are if they were dragged. */
export interface BodyState {
  x_mm: number;
  y_mm: number;
  z_mm: number;
  roll_deg: number;
  pitch_deg: number;
  yaw_deg: number;
  /** Null for the robot's own. */
  body_height_mm: number | null;
  knee: "up" | "down";
  /** Legs x (x, y, z) in G; null for the rest stance. */
  feet_mm: number[] | null;
}

/** What this server takes at most; a client that keeps to it is never refused. */
export interface Bounds {
  message_bytes: number;
  messages_per_s: number;
  plan_samples: number;
  /** A session that says nothing for so long is ended; 0 where it never is. */
  idle_s: number;
}

/** A joint beyond its limits. */
export interface BrokenLimit {
  leg: number;
  joint: "coxa" | "femur" | "tibia";
  angle_deg: number;
  low_deg: number;
  high_deg: number;
  text: string;
}

/** Servos of the catalogue that would do. */
export interface Candidate {
  name: string;
  coxa: string;
  femur: string;
  tibia: string;
  factor: number | null;
  thermal_ratio: number | null;
  servo_mass_kg: number;
  robot_mass_kg: number;
}

/** Show a source document's equations with the live numbers. Answer: source. */
export interface ChooseSource {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "source";
  source: SourceChoice;
}

/** A command to the live robot, which holds until the next; null leaves a quantity unchanged. Answer: done. */
export interface Command {
  id: number;
  type: "command";
  /** Forward, left. */
  velocity_mm_s: [number, number];
  turn_deg_s: number;
  /** x, y, z [mm], roll, pitch, yaw [deg] against the level body. */
  body?: [number, number, number, number, number, number] | null;
  gait?: string | null;
  body_height_mm?: number | null;
  swing_height_mm?: number | null;
  cycle_time_s?: number | null;
  /** Requested state. */
  state?: "standing" | "lying" | "folded" | null;
}

/** A walk round a centre on the floor. */
export interface Curve {
  kind: "curve";
  /** Negative is clockwise. */
  angle_deg: number;
  centre_mm: [number, number];
}

/** One number of the robot file, and where it comes from. */
export interface Dimension {
  key: string;
  value: unknown;
  source: string | null;
  confidence: string | null;
  note: string | null;
}

/** The end of an answer. */
export interface Done {
  type: "done";
  id: number | null;
  /** Whether a newer message of the same type took its place. */
  dropped: boolean;
  /** Whether there is something to undo. */
  undo: boolean;
  redo: boolean;
  /** The state as a short URL-safe text; null: unchanged. */
  state: string | null;
}

/** Ask for a file. Answer: file. */
export interface Download {
  id: number;
  type: "download";
  what: "csv" | "html" | "toml" | "angles";
}

/**
 * Put one foot elsewhere: in the view Joints that leg's angles follow, else its foothold.
 *
 * Answers: pose, and with `commit` the state before it.
 */
export interface DragFoot {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "drag_foot";
  leg: number;
  /** In G. */
  position_mm: [number, number, number];
}

/** Begin or end live walking. While it is on, frames come by themselves, with this message's id. */
export interface Drive {
  id: number;
  type: "drive";
  on: boolean;
}

/** State of the live robot after a tick; sent 60 times a second while driving. */
export interface DriveFrame {
  id: number;
  type: "frame";
  time_s: number;
  state: "lying" | "folded" | "rising" | "standing" | "walking" | "sitting" | "folding" | "fault";
  /** Walk state, stage of rising, sitting or folding, or the state. */
  activity: string;
  /** State of the guard: passing, holding, sitting or recovering. */
  guard: string;
  gait: string;
  position_mm: number[];
  rpy_deg: number[];
  /** Yaw of the body in G, from -180 to 180. */
  heading_deg: number;
  angles_deg: number[];
  contacts: string;
  /** Whether the body rests on the ground. */
  belly: boolean;
  /** Null where no foot is on the ground, or the body is. */
  margin_mm: number | null;
  /** (x, y) of the centre of mass over the ground in G; null while the body rests on the ground. */
  com_mm: number[] | null;
  /** Present twist: forward, left [mm/s], turn [deg/s]. */
  twist: number[];
  /** Why the command is not met in full. */
  limitations: string[];
  /** Number of interventions of the guard since driving started. */
  intervention_count: number;
  /** The latest interventions, newest first, at most five. */
  interventions: string[];
}

/** A line of a source document, with the live numbers in it. */
export interface Equation {
  key: string;
  name: string;
  symbol: MathNode;
  /** Null where the number is given. */
  formula: MathNode | null;
  /** The formula with the numbers filled in. */
  numbers: MathNode | null;
  /** All of it in one line of text. */
  plain: string;
  value: number | null;
  unit: string;
  /** The same in Tarsus' own words, such as coxa or tibia + 90 deg. */
  ours: string | null;
  /** What the document prints for its own robot. */
  printed_value: string | null;
  note: string | null;
}

/** A mistake in a document, and what it would make of the live numbers. */
export interface Erratum {
  printed: string;
  right: string;
  why: string;
  printed_formula: MathNode | null;
  right_formula: MathNode | null;
  printed_value: number | null;
  right_value: number | null;
  unit: string;
}

/** What was asked for is not possible; the state is what it was. */
export interface ErrorMessage {
  type: "error";
  /** Null where the message was so malformed that its id is unknown. */
  id: number | null;
  kind: "message" | "limit" | "input" | "unknown_name" | "robot_file" | "missing_data" | "unreachable" | "stroke" | "collision" | "unavailable" | "internal";
  text: string;
  problems: Problem[];
  longest_stroke_mm: number | null;
}

/** A file to save. */
export interface FileMessage {
  id: number;
  type: "file";
  name: string;
  mime: string;
  text: string;
}

/** The first message. Answers: welcome, then all that `open` answers. */
export interface Hello {
  id: number;
  type: "hello";
  /** The state to go on with; null begins anew. */
  state?: string | null;
}

/** What one joint bears over the walk. */
export interface JointLoad {
  leg: string;
  joint: "coxa" | "femur" | "tibia";
  servo: string | null;
  peak_nm: number;
  peak_at_s: number;
  peak_cause: string;
  rms_nm: number;
  peak_speed_deg_s: number;
  peak_power_w: number;
  stall_nm: number | null;
  factor: number | null;
  utilisation: number | null;
  thermal_ratio: number | null;
  /** good, marginal, stalls or burns, cannot stand, unknown. */
  grade: string;
  text: string;
}

/** The greatest speed of one kind of joint. */
export interface JointSpeed {
  joint: "coxa" | "femur" | "tibia";
  deg_s: number;
  leg: string;
  servo: string | null;
  no_load_deg_s: number | null;
  share_of_no_load: number | null;
}

/** The view Joints: legs x (coxa, femur, tibia); null for those of the rest stance. */
export interface JointsState {
  angles_deg: number[] | null;
}

/** Why a leg can't have its foot where it should be. */
export interface LegProblem {
  leg: number;
  reach: "TOO_FAR" | "TOO_NEAR" | "COXA_LIMIT" | "FEMUR_LIMIT" | "TIBIA_LIMIT" | "BELOW_GROUND";
  /** How far the foot is from where it should be. */
  miss_mm: number;
  text: string;
}

/** The view Loads, on top of the walk's options. */
export interface LoadOptions {
  payload_kg: number;
  /** In the body frame B. */
  payload_at_mm: [number, number, number];
  /** Null for that of the servos' figures. */
  supply_v: number | null;
  inertial: boolean;
  /** Of the battery. */
  capacity_ah: number | null;
  safety_factor: number;
  rule: "factor" | "continuous";
}

/** What the joints bear at the moments of the walk that was sent last. */
export interface LoadsMessage {
  id: number;
  type: "loads";
  /** n x legs x (coxa, femur, tibia). */
  torques_nm: number[];
  /** n x legs x (x, y, z), ground on foot in G. */
  forces_n: number[];
  /** Leg by leg. */
  joints: JointLoad[];
  /** The worst coxa, femur and tibia. */
  worst: string[];
  grade: string;
  carried: boolean;
  balanced: boolean;
  weight_n: number;
  distance_m: number;
  energy_j: number;
  cost_of_transport: number | null;
  peak_current_a: number | null;
  mean_current_a: number | null;
  battery_min: number | null;
  supply_warning: string | null;
  assumed: string[];
}

/** A piece of presentation MathML: a tag, and either text or children. */
export interface MathNode {
  tag: "mrow" | "mi" | "mn" | "mo" | "mtext" | "mfrac" | "msup" | "msub" | "msqrt";
  text: string | null;
  children: MathNode[];
}

/** Take the state that a text holds. Answers: robot, state, what the view shows. */
export interface OpenState {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "open";
  state: string;
}

/** A gait without a name. */
export interface OwnGait {
  /** Share of the cycle that a foot is down. */
  duty_factor: number;
  /** When in the cycle each leg touches down, from 0 to 1. */
  offsets: number[];
}

/** How it is looked at: the server keeps it for the link, and makes nothing of it. */
export interface Picture {
  camera: "free" | "follow" | "top" | "side" | "front";
  eye_mm: [number, number, number] | null;
  target_mm: [number, number, number] | null;
  /** Moment of the walk that is shown. */
  time_s: number;
  /** The leg whose reachable zone is shown. */
  leg: number | null;
}

/** Nothing, to keep an idle session. Answer: done. */
export interface Ping {
  id: number;
  type: "ping";
}

/** What the self-contained page of a walk holds, as JSON in its element `#motion`. */
export interface PlayerData {
  robot: RobotMessage;
  walk: WalkMessage;
  /** Null where the robot's masses are unknown. */
  loads: LoadsMessage | null;
}

/** The robot standing or resting. */
export interface PoseMessage {
  id: number;
  type: "pose";
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  /** Of B in G. */
  position_mm: number[];
  rpy_deg: number[];
  /** Legs x (coxa, femur, tibia); the nearest where a leg can't reach. */
  angles_deg: number[];
  /** Legs x (x, y, z) in G: where the feet should be. */
  feet_mm: number[];
  /** A character a leg, 1 where the foot stands. */
  contacts: string;
  /** Legs x (coxa axis, femur axis, knee, foot), 1 where one touches the ground. */
  points_down: string;
  /** How many corners of the body's box touch the ground. */
  corners_down: number;
  /** Null where nothing stands. */
  margin_mm: number | null;
  stable: boolean;
  /** Centre of mass in G. */
  com_mm: number[];
  /** Corners (x, y) of the polygon of all that touches. */
  support_mm: number[];
  /** Legs x (x, y, z), ground on foot; null where undetermined. */
  forces_n: number[] | null;
  /** Legs x (coxa, femur, tibia); null where undetermined. */
  torques_nm: number[] | null;
  legs: LegProblem[];
  limits: BrokenLimit[];
  /** How it stands, in words. */
  text: string;
  problems: string[];
  /** How far towards the requested body pose is possible, 0 to 1. */
  feasible_fraction: number | null;
}

/** One thing that is wrong in a robot file. */
export interface Problem {
  /** Path of the key, such as legs[2].position_mm; null where there is none. */
  key: string | null;
  text: string;
}

/** Take an undo back. Answers: as for undo. */
export interface Redo {
  id: number;
  type: "redo";
}

/** Which robot: a preset by its name, or a robot of one's own by the keys of its file. */
export interface RobotChoice {
  preset: string | null;
  document: RobotFile | null;
}

/**
 * The robot, sent once: all that forward kinematics needs.
 *
 * The points of a leg in B, with c, f, t for its angles: the coxa axis is at ``mount``. From there the femur axis is
 * ``coxa`` outward and ``femur_axis_offset`` to the left of outward and up. The knee is ``femur (cos f outward +
 * sin f up)`` farther, the foot ``tibia (cos(f + t) outward + sin(f + t) up)`` farther still. Outward is
 * ``(cos(yaw + c), sin(yaw + c), 0)``, its left ``(-sin(yaw + c), cos(yaw + c), 0)``, yaw that of the mount. The body
 * takes B into G by ``Rz(yaw) Ry(pitch) Rx(roll)`` and its position.
 */
export interface RobotMessage {
  id: number;
  type: "robot";
  name: string;
  /** The preset's name while nothing of it is changed. */
  preset: string | null;
  leg_names: string[];
  /** Short names: LF, LM, LR, RR, RM, RF. */
  leg_codes: string[];
  /** Legs x (x, y, z) in B. */
  mount_mm: number[];
  mount_yaw_deg: number[];
  coxa_mm: number[];
  femur_mm: number[];
  tibia_mm: number[];
  /** Legs x (to the left of outward, up). */
  femur_axis_offset_mm: number[];
  /** Legs x (coxa, femur, tibia) x (lowest, highest). */
  limits_deg: number[];
  foot_radius_mm: number[];
  /** Box centred on B's origin; null: polygon of coxa axes. */
  body_size_mm: number[] | null;
  mass_kg: number | null;
  /** Legs x (coxa, femur, tibia). */
  servos: (string | null)[];
  /** Legs x (coxa, femur, tibia), as in the catalogue. */
  stall_torque_nm: (number | null)[];
  body_height_mm: number;
  swing_height_mm: number;
  gait: string;
  /** Those that a robot of so many legs has. */
  gaits: string[];
  /** Rest footholds in G, body over the origin; null: none. */
  stance_mm: number[] | null;
  stance_angles_deg: number[] | null;
  /** Straight ahead with its own gait. */
  longest_stroke_mm: number | null;
  document: RobotFile;
  dimensions: Dimension[];
  /** What the file does not say, and what that costs. */
  missing: string[];
  /** Why the robot can't walk; empty where it can. */
  problems: string[];
}

/** Which servos would do. */
export interface ServosMessage {
  id: number;
  type: "servos";
  present_do: boolean;
  balanced: boolean;
  /** A line on the worst coxa, femur and tibia of the present servos. */
  worst: string[];
  /** The same servo in all joints, the lightest first. */
  candidates: Candidate[];
  /** The lightest for each kind of joint. */
  mixed: Candidate | null;
  /** The heaviest that the present servos carry. */
  payload_kg: number | null;
  payload_before_burning_kg: number | null;
  advice: string[];
  left_out: Record<string, string>;
  assumed: string[];
}

/** Move the body over its feet. Answer: pose. */
export interface SetBody {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "body";
  body: BodyState;
}

/** Take a robot by the keys of its file; poses and walk stay. Answers: robot, state, what the view shows. */
export interface SetDocument {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "document";
  document: RobotFile;
}

/** Turn joints; the robot rests as it would. Answer: pose. */
export interface SetJoints {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "joints";
  joints: JointsState;
}

/** Work out what the walk asks of the joints. Answer: loads, with walk where it was not sent since it changed. */
export interface SetLoads {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "loads";
  loads: LoadOptions;
}

/** Take a preset; poses and walk begin anew. Answers: robot, state, what the view shows. */
export interface SetRobot {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "robot";
  preset: string;
}

/** Take a robot by the text of its file. Answers: robot, state, what the view shows. */
export interface SetToml {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "toml";
  text: string;
}

/** Go to a view, or look at it differently; no step of undo. Answers, where the view changes: what it shows. */
export interface SetView {
  id: number;
  type: "view";
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  picture?: Picture | null;
}

/** Plan a walk. Answer: walk; in the view Loads also loads. */
export interface SetWalk {
  id: number;
  /** Whether undo shall come back to what is here now. */
  commit?: boolean;
  type: "walk";
  walk: WalkOptions;
}

/** Tell what a leg reaches with the body as it is. Answer: zone. */
export interface ShowWorkspace {
  id: number;
  type: "workspace";
  leg: number;
}

/** Choose servos for the walk and the payload; takes a second or two. Answer: servos. */
export interface SizeServos {
  id: number;
  type: "servos";
}

/** The view Sources: which document, filled in with which leg's numbers. */
export interface SourceChoice {
  number: "000" | "001" | "002" | "003" | "004";
  leg: number;
}

/** One of the five source documents. */
export interface SourceMessage {
  id: number;
  type: "source";
  number: string;
  title: string;
  about: string;
  leg: number;
  equations: Equation[];
  errata: Erratum[];
}

/** The state after something else than the client's own inputs changed it: all inputs take these values. */
export interface StateMessage {
  id: number;
  type: "state";
  state: StudioState;
}

/** A straight walk. */
export interface Straight {
  kind: "straight";
  distance_mm: number;
  /** From the front; 90 is to the left. */
  heading_deg: number;
}

/** The whole state of a visitor's studio. */
export interface StudioState {
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  robot: RobotChoice;
  joints: JointsState;
  body: BodyState;
  walk: WalkOptions;
  loads: LoadOptions;
  source: SourceChoice;
  picture: Picture;
}

/** A length and when it is so. */
export interface TimedLength {
  mm: number | null;
  at_s: number;
}

/** A walk at a constant twist. */
export interface Twist {
  kind: "twist";
  velocity_mm_s: [number, number];
  turn_deg_s: number;
  duration_s: number;
}

/** Go back to the commit before. Answers: robot where it changed, state, what the view shows. */
export interface Undo {
  id: number;
  type: "undo";
}

/** Where the body is in the end. */
export interface WalkEnd {
  x_mm: number;
  y_mm: number;
  turned_deg: number;
}

/** A whole walk, for playing without a round trip. Moments are `rate_hz` apart, the first at 0 s. */
export interface WalkMessage {
  id: number;
  type: "walk";
  rate_hz: number;
  /** How many moments: n. */
  count: number;
  /** n x (x, y, z) of B in G. */
  position_mm: number[];
  /** n x (roll, pitch, yaw), yaw without jumps. */
  rpy_deg: number[];
  /** n x legs x (coxa, femur, tibia). */
  angles_deg: number[];
  /** n texts, a character a leg, 1 where the foot stands. */
  contacts: string[];
  /** n texts, a code of Reach a leg; null where all reach. */
  reach: string[] | null;
  /** n; null where no foot stands. */
  margin_mm: (number | null)[];
  /** n x (x, y) of the centre of mass over the ground in G. */
  com_mm: number[];
  gait: string;
  duty_factor: number;
  duration_s: number;
  cycle_time_s: number;
  steps: number;
  stroke_mm: number;
  speed_mm_s: number;
  body_height_mm: number;
  swing_height_mm: number;
  longest_stroke_mm: number | null;
  end: WalkEnd;
  joint_speed: JointSpeed[];
  least_margin: TimedLength;
  nearest_feet: TimedLength;
  nearest_legs: string[];
  possible: boolean;
  problems: string[];
  assumed: string[];
}

/** The view Walk: every option of `plan_walk`; null leaves it to the plan, which then says what it took. */
export interface WalkOptions {
  /** Null for the robot's own. */
  gait: string | OwnGait | null;
  path: Straight | Curve | Twist;
  stroke_mm: number | null;
  speed_mm_s: number | null;
  cycle_time_s: number | null;
  body_height_mm: number | null;
  swing_height_mm: number | null;
  roll_deg: number;
  pitch_deg: number;
  foot_distance_mm: number | null;
  rate_hz: number;
  /** Refuse what does not work; if false, show it with its problems. */
  strict: boolean;
}

/** The first answer: what there is here. */
export interface Welcome {
  id: number;
  type: "welcome";
  version: string;
  /** Names of the presets. */
  robots: string[];
  gaits: string[];
  /** Names in the catalogue. */
  servos: string[];
  /** Whether this is a public server: the simulator, and nothing else. */
  public: boolean;
  bounds: Bounds;
  /** JSON schema of a robot file: descriptions and bounds of its keys. */
  robot_schema: Record<string, unknown>;
}

/** What a leg reaches, as closed outlines in B: they move with the body. Empty where it reaches nothing there. */
export interface WorkspaceMessage {
  id: number;
  type: "workspace";
  leg: number;
  /** Points (x, y, z) of the outline on the ground. */
  ground_mm: number[];
  /** Points (x, y, z) of the outline in the leg's present plane. */
  plane_mm: number[];
  /** Straight out on the ground, from the coxa axis. */
  nearest_mm: number | null;
  farthest_mm: number | null;
}

export type ClientMessage =
  | Hello
  | Ping
  | SetView
  | SetRobot
  | SetDocument
  | SetToml
  | SetJoints
  | SetBody
  | DragFoot
  | SetWalk
  | SetLoads
  | SizeServos
  | ShowWorkspace
  | ChooseSource
  | Drive
  | Command
  | Undo
  | Redo
  | OpenState
  | Download;

export type ServerMessage =
  | Welcome
  | RobotMessage
  | StateMessage
  | PoseMessage
  | WorkspaceMessage
  | WalkMessage
  | LoadsMessage
  | ServosMessage
  | DriveFrame
  | SourceMessage
  | FileMessage
  | ErrorMessage
  | Done;

/** A legged robot for Tarsus: millimetres, degrees, kilograms; x forward, y left, z up. */
export interface RobotFile {
  /** Name of the robot. */
  name: string;
  body?: FileBody;
  leg?: FileLeg;
  /** The legs, counter-clockwise from the front left. */
  legs: FileLegEntry[];
  gait?: FileGait;
  /** Sources of the numbers in this file. */
  sources?: FileSourceEntry[];
}

/** The body, without the legs. */
export interface FileBody {
  /** Mass, including battery and electronics [kg]. */
  mass_kg?: number;
  /** Centre of mass: x forward, y left, z up [mm]. */
  com_mm?: number[];
  /** Length, width and height of its box [mm]. Default: the flat polygon of the coxa axes. */
  size_mm?: number[];
}

/** Default settings of the robot's walks. */
export interface FileGait {
  /** The gait. */
  name?: "tripod" | "tetrapod" | "amble" | "ripple" | "wave";
  /** Height of the body's origin above the ground [mm]. */
  body_height_mm?: number;
  /** Swing height [mm]. */
  swing_height_mm?: number;
}

/** Centres of mass of the links, along the link from its inner joint [mm]. Default: the middle. */
export interface FileJointCentres {
  coxa?: number;
  femur?: number;
  tibia?: number;
}

/**
 * Lower and upper limit of each joint [deg].
 *
 * At zero the leg is straight and level. Coxa positive: counter-clockwise seen from above. Femur and tibia positive:
 * the foot moves up. A standing leg, knee up, has a positive femur and a negative tibia angle.
 */
export interface FileJointLimits {
  coxa?: number[];
  femur?: number[];
  tibia?: number[];
}

/** Masses of the links, servos included [kg]. Give all three, or omit the table where they are unknown. */
export interface FileJointMasses {
  coxa?: number;
  femur?: number;
  tibia?: number;
}

/** The servo of each joint: a name in the catalogue, or a table with the data of the servo. */
export interface FileJointServos {
  coxa?: string | FileServoFigures;
  femur?: string | FileServoFigures;
  tibia?: string | FileServoFigures;
}

/** Values shared by all legs. */
export interface FileLeg {
  /** Coxa axis to femur axis, outward [mm]. */
  coxa_mm?: number;
  /** Femur axis to knee [mm]. */
  femur_mm?: number;
  /** Knee to foot [mm]. */
  tibia_mm?: number;
  /** Offset of the femur axis from the coxa axis: [sideways, vertical] [mm]. */
  femur_axis_offset_mm?: number[];
  mass_kg?: FileJointMasses;
  com_mm?: FileJointCentres;
  limits_deg?: FileJointLimits;
  /** A servo of the catalogue, one for each joint, or a table with the data of the servo. */
  servo?: string | FileServoFigures | FileJointServos;
  /** Radius of the spherical foot [mm]. */
  foot_radius_mm?: number;
}

/** One leg: its name and position, and values that differ from [leg]. */
export interface FileLegEntry {
  /** Coxa axis to femur axis, outward [mm]. */
  coxa_mm?: number;
  /** Femur axis to knee [mm]. */
  femur_mm?: number;
  /** Knee to foot [mm]. */
  tibia_mm?: number;
  /** Offset of the femur axis from the coxa axis: [sideways, vertical] [mm]. */
  femur_axis_offset_mm?: number[];
  mass_kg?: FileJointMasses;
  com_mm?: FileJointCentres;
  limits_deg?: FileJointLimits;
  /** A servo of the catalogue, one for each joint, or a table with the data of the servo. */
  servo?: string | FileServoFigures | FileJointServos;
  /** Radius of the spherical foot [mm]. */
  foot_radius_mm?: number;
  /** Name of the leg, such as front left. */
  name: string;
  /** Position of the coxa axis: x forward, y left, z up [mm]. */
  position_mm: number[];
  /** Direction of the leg: 0 is forward, 90 is left [deg]. */
  yaw_deg: number;
}

/** Data of a servo that is not in the catalogue. */
export interface FileServoFigures {
  /** Name of the model. */
  name: string;
  /** Stall torque [N m]; kg.cm times 0.0980665. */
  stall_torque_nm: number;
  /** Supply voltage of the stall torque [V]. */
  torque_at_v?: number;
  /** Rated continuous torque [N m]. */
  rated_torque_nm?: number;
  /** No-load speed [rad/s]; 1.047 divided by the seconds for 60 deg. */
  no_load_rad_s?: number;
  /** Supply voltage of the no-load speed [V]. */
  speed_at_v?: number;
  /** Stall current [A]. */
  stall_current_a?: number;
  /** Mass [g]. */
  mass_g?: number;
  /** Least supply voltage [V]; requires supply_max_v. */
  supply_min_v?: number;
  /** Greatest supply voltage [V]; requires supply_min_v. */
  supply_max_v?: number;
  /** Range of the output shaft [deg]. */
  travel_deg?: number;
  /** Manufacturer. */
  maker?: string;
  /** Command interface. */
  control?: string;
  /** Gear material. */
  gear?: string;
  /** Feedback. */
  feedback?: string;
  /** Confidence of the data. */
  confidence?: string;
  /** Source of the data. */
  source?: string;
  /** Remarks. */
  note?: string;
}

/** Source of numbers in this file, and their confidence. */
export interface FileSourceEntry {
  /** The keys concerned, such as leg.coxa_mm. */
  of: string[];
  /** Where the numbers were found. */
  source: string;
  /** Confidence: A from the primary source, B from a secondary copy, C general knowledge, or guess. */
  confidence: "A" | "A-" | "B" | "C" | "guess";
  /** Remarks. */
  note?: string;
}
