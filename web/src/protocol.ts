// Written by `make protocol` from src/tarsus/studio/messages. Do not edit.

/** Path of the socket on the page's host. */
export const SOCKET = "/session/1";

/** Codes with which the server closes the socket. */
export const CLOSED = {
  /** Missing or wrong token: open the link that the server printed. */
  TOKEN: 4401,
  /** No message for too long; clients may reconnect. */
  IDLE: 4408,
  /** Too many messages, or too many malformed ones. */
  RATE: 4429,
  /** The server has reached its number of sessions; clients may retry later. */
  FULL: 4503,
  /** A message was larger than `bounds.message_bytes`. */
  LARGE: 1009,
} as const;

/** Answer a question of the bring-up. Answer: done; the next question follows when it is asked. */
export interface Answer {
  id: number;
  type: "answer";
  number: number;
  /** Key of one of the choices. */
  key: string;
}

/** The view Body: body pose relative to the feet, and footholds that were dragged. */
export interface BodyState {
  x_mm: number;
  y_mm: number;
  z_mm: number;
  roll_deg: number;
  pitch_deg: number;
  yaw_deg: number;
  /** Null for the default of the robot. */
  body_height_mm: number | null;
  knee: "up" | "down";
  /** Legs x (x, y, z) in G; null for the default stance. */
  feet_mm: number[] | null;
}

/** Limits of the server; clients that respect them are never rejected. */
export interface Bounds {
  message_bytes: number;
  messages_per_s: number;
  plan_samples: number;
  /** Time without messages after which a session ends; 0 for no limit. */
  idle_s: number;
}

/** Begin, resume or leave the bring-up of this robot's servos. While it is on, bring_up is sent with this id. */
export interface BringUp {
  id: number;
  type: "bring_up";
  on: boolean;
}

/** How far a bring-up is; sent whenever that changes. */
export interface BringUpMessage {
  id: number;
  type: "bring_up";
  state: "asking" | "moving" | "done" | "left" | "failed";
  /** The calibration file, saved after every answer. */
  file: string;
  /** What was told lately, the latest last. */
  said: string[];
  /** Null while servos move, and in the end. */
  question: Question | null;
  /** Number of joints that are calibrated. */
  known: number;
  joints: number;
  /** Legs x (coxa, femur, tibia): where emulated servos are; of real ones the reference pose. */
  angles_deg: number[];
  emulated: boolean;
  /** Why it failed. */
  problem: string | null;
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

/**
 * The calibration whose pulses are shown: the command of a joint at an angle is zero + per_deg * angle.
 *
 * All lists are legs x (coxa, femur, tibia), and empty without a calibration that fits the robot.
 */
export interface CalibrationMessage {
  id: number;
  type: "calibration";
  /** Name of its file; null for none. */
  name: string | null;
  /** Why it does not fit the robot. */
  problem: string | null;
  /** us or ticks. */
  unit: string[];
  zero: number[];
  per_deg: number[];
  /** Least command. */
  low: number[];
  /** Greatest command. */
  high: number[];
  /** Least angle. */
  low_deg: number[];
  /** Greatest angle. */
  high_deg: number[];
}

/** Suitable servos of the catalogue. */
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

/** A possible answer. */
export interface Choice {
  key: string;
  text: string;
}

/** Show the equations of a source document with live values. Answer: source. */
export interface ChooseSource {
  id: number;
  /** Whether undo returns to the state after this change. */
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
  /** x, y, z [mm], roll, pitch, yaw [deg] relative to the level body. */
  body?: [number, number, number, number, number, number] | null;
  gait?: string | null;
  body_height_mm?: number | null;
  swing_height_mm?: number | null;
  cycle_time_s?: number | null;
  /** Requested state. */
  state?: "standing" | "lying" | "folded" | null;
}

/** A walk around a centre on the ground. */
export interface Curve {
  kind: "curve";
  /** Negative is clockwise. */
  angle_deg: number;
  centre_mm: [number, number];
}

/** A value of the robot file, with its source. */
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
  /** Whether a newer message of the same type replaced it. */
  dropped: boolean;
  /** Whether there is something to undo. */
  undo: boolean;
  redo: boolean;
  /** State as URL-safe text; null if unchanged. */
  state: string | null;
}

/** Export a file. Answer: file. */
export interface Download {
  id: number;
  type: "download";
  what: "csv" | "html" | "toml" | "angles";
}

/**
 * Move one foot: in the view Joints by changing the joint angles, else the foothold.
 *
 * Answers: pose; with `commit`, state before it.
 */
export interface DragFoot {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  /** Whether the answer has forces and torques; with `commit` it always has. */
  forces?: boolean;
  type: "drag_foot";
  leg: number;
  /** In G. */
  position_mm: [number, number, number];
}

/** Start or stop driving. While it is on, frames are sent with the id of this message. */
export interface Drive {
  id: number;
  type: "drive";
  on: boolean;
}

/** State of the live robot after a tick, as commanded; sent 60 times a second while driving. */
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
  /** Null as planned, without physics. */
  physics: FramePhysics | null;
  /** Null without servos. */
  machine: FrameMachine | null;
}

/** Stop the robot that is driven, and end the run that this server belongs to. Answer: done. */
export interface EndRun {
  id: number;
  type: "end_run";
}

/** An equation of a source document with live values. */
export interface Equation {
  key: string;
  name: string;
  symbol: MathNode;
  /** Null for a given quantity. */
  formula: MathNode | null;
  /** The formula with the values substituted. */
  numbers: MathNode | null;
  /** The whole equation as text. */
  plain: string;
  value: number | null;
  unit: string;
  /** The same quantity in Tarsus, such as coxa or tibia + 90 deg. */
  ours: string | null;
  /** Value printed in the document for its robot. */
  printed_value: string | null;
  note: string | null;
}

/** An erratum of a document, with the results of both formulas. */
export interface Erratum {
  printed: string;
  correct: string;
  reason: string;
  printed_formula: MathNode | null;
  correct_formula: MathNode | null;
  printed_value: number | null;
  correct_value: number | null;
  unit: string;
}

/** A request is not possible; the state is unchanged. */
export interface ErrorMessage {
  type: "error";
  /** Null if the id of a malformed message is unknown. */
  id: number | null;
  kind: "message" | "limit" | "input" | "unknown_name" | "robot_file" | "missing_data" | "unreachable" | "stroke" | "collision" | "unavailable" | "internal";
  text: string;
  problems: Problem[];
  longest_stroke_mm: number | null;
}

/** An exported file. */
export interface FileMessage {
  id: number;
  type: "file";
  name: string;
  mime: string;
  text: string;
}

/** What the servos of a robot that runs measure, where the frame itself has what is commanded. */
export interface FrameMachine {
  /** Legs x (coxa, femur, tibia); null for a joint that is not measured. */
  angles_deg: (number | null)[];
  /** Greatest difference of commanded and measured angles. */
  behind_deg: number | null;
  behind_joint: string | null;
  /** Lowest of the supply. */
  voltage_v: number | null;
  /** Of the warmest servo. */
  temperature_c: number | null;
  temperature_joint: string | null;
  /** Ticks per second. */
  rate_hz: number;
  /** Ticks that came too late. */
  missed: number;
  /** Whether the deadman has stopped the robot, as nothing was heard of the driver. */
  stopped: boolean;
  /** Faults, and what else the servos report. */
  problems: string[];
}

/** A driven robot in physics, where the frame itself has what is commanded. */
export interface FramePhysics {
  position_mm: number[];
  rpy_deg: number[];
  angles_deg: number[];
  contacts: string;
  /** Legs x (x, y, z), ground on foot in G. */
  forces_n: number[];
  /** Of each foot. */
  slip_mm_s: number[];
  /** A character per joint, 1 for a servo at its maximum torque. */
  saturated: string;
  /** Angle between the body and the commanded one. */
  tilt_deg: number;
  /** Horizontal distance from where it is commanded to be. */
  deviation_mm: number;
  /** Whether it has fallen since driving started. */
  fallen: boolean;
  /** Falls, and servos at their maximum torque within the last half second. */
  problems: string[];
}

/** Whether this session has access to servos. */
export interface HardwareOffer {
  /** Why it has none; null if it has. */
  missing: string | null;
}

/** The first message. Answers: welcome, and the answers to `open`. */
export interface Hello {
  id: number;
  type: "hello";
  /** State to restore; null for the default. */
  state?: string | null;
}

/** Loads of one joint over the walk. */
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

/** Greatest speed of one kind of joint. */
export interface JointSpeed {
  joint: "coxa" | "femur" | "tibia";
  deg_s: number;
  leg: string;
  servo: string | null;
  no_load_deg_s: number | null;
  no_load_fraction: number | null;
}

/** The view Joints: legs x (coxa, femur, tibia); null for the default stance. */
export interface JointsState {
  angles_deg: number[] | null;
}

/** A foot that does not reach its target. */
export interface LegProblem {
  leg: number;
  reach: "TOO_FAR" | "TOO_NEAR" | "COXA_LIMIT" | "FEMUR_LIMIT" | "TIBIA_LIMIT" | "BELOW_GROUND";
  /** Distance of the foot from its target. */
  miss_mm: number;
  text: string;
}

/** The view Loads, in addition to the options of the walk. */
export interface LoadOptions {
  payload_kg: number;
  /** In the body frame B. */
  payload_at_mm: [number, number, number];
  /** Null for the voltage of the servo data. */
  supply_v: number | null;
  inertial: boolean;
  /** Of the battery. */
  capacity_ah: number | null;
  safety_factor: number;
  rule: "factor" | "continuous";
}

/** Joint loads at the samples of the walk that was sent last. */
export interface LoadsMessage {
  id: number;
  type: "loads";
  /** n x legs x (coxa, femur, tibia). */
  torques_nm: number[];
  /** n x legs x (x, y, z), ground on foot in G. */
  forces_n: number[];
  /** In the order of the legs. */
  joints: JointLoad[];
  /** Names of the most loaded coxa, femur and tibia. */
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

/** An element of presentation MathML: a tag, and either text or children. */
export interface MathNode {
  tag: "mrow" | "mi" | "mn" | "mo" | "mtext" | "mfrac" | "msup" | "msub" | "msqrt";
  text: string | null;
  children: MathNode[];
}

/** Restore a state from its text. Answers: robot, state, content of the view. */
export interface OpenState {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "open";
  state: string;
}

/** A custom gait. */
export interface OwnGait {
  /** Stance time as a fraction of the cycle time. */
  duty_factor: number;
  /** Phase of the touch-down of each leg, from 0 to 1. */
  offsets: number[];
}

/** What physics the server has. */
export interface PhysicsOffer {
  /** Why there is no physics, and what to install; null where there is. */
  missing: string | null;
  terrains: TerrainKind[];
}

/** Physics in the views Walk and Drive. */
export interface PhysicsOptions {
  /** Whether the robot is shown in physics. */
  on: boolean;
  terrain: TerrainChoice;
  servos: "catalogue" | "ideal";
  /** What the controller reads while driving. */
  sensors: "ideal" | "hobby" | "smart" | "blind";
}

/** Camera and time of the 3D view, which the server stores for links only. */
export interface Picture {
  camera: "free" | "follow" | "top" | "side" | "front";
  eye_mm: [number, number, number] | null;
  target_mm: [number, number, number] | null;
  /** Playback time. */
  time_s: number;
  /** Leg whose workspace is shown. */
  leg: number | null;
}

/** No operation; keeps an idle session open. Answer: done. */
export interface Ping {
  id: number;
  type: "ping";
}

/** Data of the offline player, as JSON in its element `#motion`. */
export interface PlayerData {
  robot: RobotMessage;
  walk: WalkMessage;
  /** Null if the masses of the robot are unknown. */
  loads: LoadsMessage | null;
}

/** The standing or resting robot. */
export interface PoseMessage {
  id: number;
  type: "pose";
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  /** Of B in G. */
  position_mm: number[];
  rpy_deg: number[];
  /** Legs x (coxa, femur, tibia); the nearest solution for a leg out of reach. */
  angles_deg: number[];
  /** Legs x (x, y, z) in G: targets of the feet. */
  feet_mm: number[];
  /** A character per leg, 1 for a foot in contact. */
  contacts: string;
  /** Legs x (coxa axis, femur axis, knee, foot), 1 for points on the ground. */
  points_down: string;
  /** Number of corners of the body's box on the ground. */
  corners_down: number;
  /** Null without contacts. */
  margin_mm: number | null;
  stable: boolean;
  /** Centre of mass in G. */
  com_mm: number[];
  /** Corners (x, y) of the support polygon of all contact points. */
  support_mm: number[];
  /** Legs x (x, y, z), ground on foot; null if undetermined. */
  forces_n: number[] | null;
  /** Legs x (coxa, femur, tibia); null if undetermined. */
  torques_nm: number[] | null;
  legs: LegProblem[];
  limits: BrokenLimit[];
  /** Description of the pose. */
  text: string;
  problems: string[];
  /** How far towards the requested body pose is possible, 0 to 1. */
  feasible_fraction: number | null;
}

/** A problem in a robot file. */
export interface Problem {
  /** Path of the key, such as legs[2].position_mm; null if the problem has no key. */
  key: string | null;
  text: string;
}

/** A question with its possible answers, of which the first is the usual one. */
export interface Question {
  /** Answers have the number of their question. */
  number: number;
  /** The step to which it belongs. */
  title: string;
  text: string;
  choices: Choice[];
  /** Leg to highlight. */
  leg: number | null;
  /** Joint of that leg to highlight: coxa, femur, tibia. */
  joint: number | null;
}

/** Revert an undo. Answers: as for undo. */
export interface Redo {
  id: number;
  type: "redo";
}

/** Choice of the robot: a preset by its name, or a custom robot by the keys of its file. */
export interface RobotChoice {
  preset: string | null;
  document: RobotFile | null;
}

/**
 * The robot, sent once, with everything that forward kinematics needs.
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
  /** Name of the preset, if it is unchanged. */
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
  /** Gaits for this number of legs. */
  gaits: string[];
  /** Footholds of the default stance in G, body over the origin; null if there is none. */
  stance_mm: number[] | null;
  stance_angles_deg: number[] | null;
  /** Straight ahead with the default gait. */
  longest_stroke_mm: number | null;
  document: RobotFile;
  dimensions: Dimension[];
  /** Values that the file lacks, and the consequences. */
  missing: string[];
  /** Why the robot can't walk; empty if it can. */
  problems: string[];
}

/** The run that this server belongs to; then only the view Drive is available. */
export interface RunOffer {
  /** Servos: real or emulated, and their buses. */
  bus: string;
}

/** Result of the servo sizing. */
export interface ServosMessage {
  id: number;
  type: "servos";
  sufficient: boolean;
  balanced: boolean;
  /** Verdicts on the most loaded coxa, femur and tibia with the present servos. */
  worst: string[];
  /** The same servo in all joints, lightest first. */
  candidates: Candidate[];
  /** The lightest servo for each kind of joint. */
  mixed: Candidate | null;
  /** Greatest payload of the present servos. */
  payload_kg: number | null;
  maximum_payload_kg: number | null;
  advice: string[];
  left_out: Record<string, string>;
  assumed: string[];
}

/** Set the body pose relative to the feet. Answer: pose. */
export interface SetBody {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  /** Whether the answer has forces and torques; with `commit` it always has. */
  forces?: boolean;
  type: "body";
  body: BodyState;
}

/** Show the pulses of a calibration beside joint angles, or, for null, no longer. Answer: calibration. */
export interface SetCalibration {
  id: number;
  type: "calibration";
  /** Name of its file. */
  name?: string | null;
  text?: string | null;
}

/** Change the robot by the keys of its file; poses and walk are kept. Answers: robot, state, content of the view. */
export interface SetDocument {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "document";
  document: RobotFile;
}

/** Set joint angles; the resting pose follows. Answer: pose. */
export interface SetJoints {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  /** Whether the answer has forces and torques; with `commit` it always has. */
  forces?: boolean;
  type: "joints";
  joints: JointsState;
}

/** Compute the joint loads of the walk. Answer: loads; walk before it if the walk has changed since it was sent. */
export interface SetLoads {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "loads";
  loads: LoadOptions;
}

/** Change the options of physics; a robot that is driven stops being so. Answer: terrain, where physics is on. */
export interface SetPhysics {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "physics";
  physics: PhysicsOptions;
}

/** Select a preset, and reset poses and walk. Answers: robot, state, content of the view. */
export interface SetRobot {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "robot";
  preset: string;
}

/**
 * Change the robot by the text of its file; a robot of another name resets poses and walk.
 *
 * Answers: robot, state, content of the view.
 */
export interface SetToml {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "toml";
  text: string;
}

/** Change the view or the camera, which is not an undo step. Answers, if the view changes: its content. */
export interface SetView {
  id: number;
  type: "view";
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  picture?: Picture | null;
}

/** Plan a walk. Answer: walk; in the view Loads also loads. */
export interface SetWalk {
  id: number;
  /** Whether undo returns to the state after this change. */
  commit?: boolean;
  type: "walk";
  walk: WalkOptions;
}

/** Compute the workspace of a leg for the present body pose. Answer: workspace. */
export interface ShowWorkspace {
  id: number;
  type: "workspace";
  leg: number;
}

/** Simulate the walk in physics, which takes a second or two. Answer: simulated. */
export interface Simulate {
  id: number;
  type: "simulate";
}

/** Torques of one kind of joint, of the leg where each is greatest. */
export interface SimulatedJoint {
  joint: "coxa" | "femur" | "tibia";
  peak_nm: number;
  rms_nm: number;
  planned_peak_nm: number | null;
  planned_rms_nm: number | null;
  /** Of the time, at the servo's maximum torque. */
  saturated_fraction: number;
}

/** The planned walk in physics, without feedback; the samples are those of the plan at `rate_hz`. */
export interface SimulatedMessage {
  id: number;
  type: "simulated";
  rate_hz: number;
  /** Number of samples n. */
  count: number;
  /** n x (x, y, z) of B in G. */
  position_mm: number[];
  /** n x (roll, pitch, yaw), yaw unwrapped. */
  rpy_deg: number[];
  /** n x legs x (coxa, femur, tibia). */
  angles_deg: number[];
  /** n texts, a character per leg, 1 for a foot in contact. */
  contacts: string[];
  /** n; null without a foot in contact. */
  margin_mm: (number | null)[];
  /** n x (x, y) of the centre of mass in G. */
  com_mm: number[];
  /** n x legs x (x, y, z), ground on foot in G. */
  forces_n: number[];
  /** n x legs: speed of the contact point over the ground. */
  slip_mm_s: number[];
  /** n texts, a character per joint, 1 for a servo at its maximum torque. */
  saturated: string[];
  /** n: angle between the body and the planned one. */
  tilt_deg: number[];
  /** Whether it neither fell nor stalled. */
  ok: boolean;
  verdict: string;
  problems: string[];
  /** Way over the planned one; null for a walk on the spot. */
  way_ratio: number | null;
  turn_ratio: number | null;
  /** Greatest horizontal distance from the plan. */
  deviation_mm: number;
  sag_mm: number;
  /** Way that a foot slides, mean of all feet. */
  slip_mm: number;
  joints: SimulatedJoint[];
  energy_j: number;
  fell_at_s: number | null;
  assumed: string[];
}

/** Size servos for the walk and the payload, which takes a second or two. Answer: servos. */
export interface SizeServos {
  id: number;
  type: "servos";
}

/** The view Sources: the document, and the leg whose values are used. */
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

/** The state after a change that is not from the inputs of the client, which take these values. */
export interface StateMessage {
  id: number;
  type: "state";
  state: StudioState;
}

/** A straight walk. */
export interface Straight {
  kind: "straight";
  distance_mm: number;
  /** Direction, 90 is to the left. */
  heading_deg: number;
}

/** The whole state of a session. */
export interface StudioState {
  view: "joints" | "body" | "walk" | "drive" | "loads" | "robot" | "sources";
  robot: RobotChoice;
  joints: JointsState;
  body: BodyState;
  walk: WalkOptions;
  physics: PhysicsOptions;
  loads: LoadOptions;
  source: SourceChoice;
  picture: Picture;
}

/** Choice of the terrain. */
export interface TerrainChoice {
  kind: "flat" | "ramp" | "step" | "stairs" | "blocks" | "smooth" | "gaps" | "box";
  /** Parameters of the kind [mm, deg]; those left out have their default. */
  values: Record<string, number>;
}

/** A height field: each cell is two triangles, which share the edge from its least x, y to its greatest. */
export interface TerrainField {
  rows: number;
  columns: number;
  /** Least x and y, greatest x and y. */
  corners_mm: number[];
  /** Rows along y x columns along x, ascending. */
  heights_mm: number[];
}

/** A kind of terrain. */
export interface TerrainKind {
  kind: "flat" | "ramp" | "step" | "stairs" | "blocks" | "smooth" | "gaps" | "box";
  parameters: TerrainParameterRange[];
}

/** The terrain as the physics engine has it. */
export interface TerrainMessage {
  id: number;
  type: "terrain";
  kind: "flat" | "ramp" | "step" | "stairs" | "blocks" | "smooth" | "gaps" | "box";
  friction: number;
  /** Whether there is level ground without end at height 0. */
  level: boolean;
  /** n x (least x, y, z, greatest x, y, z). */
  boxes_mm: number[];
  /** n x 3 x (x, y, z), counter-clockwise seen from outside. */
  triangles_mm: number[];
  field: TerrainField | null;
}

/** A parameter of a kind of terrain, and the range of its slider. */
export interface TerrainParameterRange {
  name: string;
  unit: "mm" | "deg" | "";
  default: number;
  least: number;
  most: number;
  step: number;
}

/** A length and its time. */
export interface TimedLength {
  mm: number | null;
  at_s: number;
}

/** A walk with a constant twist. */
export interface Twist {
  kind: "twist";
  velocity_mm_s: [number, number];
  turn_deg_s: number;
  duration_s: number;
}

/** Return to the previous commit. Answers: robot, state, content of the view. */
export interface Undo {
  id: number;
  type: "undo";
}

/** Final position and heading of the body. */
export interface WalkEnd {
  x_mm: number;
  y_mm: number;
  turned_deg: number;
}

/** A complete walk, for playback in the browser: `rate_hz` samples per second, from 0 s. */
export interface WalkMessage {
  id: number;
  type: "walk";
  rate_hz: number;
  /** Number of samples n. */
  count: number;
  /** n x (x, y, z) of B in G. */
  position_mm: number[];
  /** n x (roll, pitch, yaw), yaw unwrapped. */
  rpy_deg: number[];
  /** n x legs x (coxa, femur, tibia). */
  angles_deg: number[];
  /** n texts, a character per leg, 1 for a foot in contact. */
  contacts: string[];
  /** n texts, a code of Reach per leg; null if all feet are reachable. */
  reach: string[] | null;
  /** n; null without a foot in contact. */
  margin_mm: (number | null)[];
  /** n x (x, y) of the centre of mass over the ground in G. */
  com_mm: number[];
  gait: string;
  duty_factor: number;
  /** Phase of the touch-down of each leg, from 0 to 1. */
  offsets: number[];
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

/** The view Walk: the options of `plan_walk`; for null, the plan chooses a value and reports it. */
export interface WalkOptions {
  /** Null for the default of the robot. */
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
  /** Whether impossible walks are rejected; if false, they are shown with their problems. */
  strict: boolean;
}

/** The first answer: presets, gaits, servos, and limits. */
export interface Welcome {
  id: number;
  type: "welcome";
  version: string;
  /** Names of the presets. */
  robots: string[];
  gaits: string[];
  /** Names in the servo catalogue. */
  servos: string[];
  /** Whether this is a public server, without access to hardware. */
  public: boolean;
  bounds: Bounds;
  physics: PhysicsOffer;
  /** Null without a run: then all views are available. */
  run: RunOffer | null;
  hardware: HardwareOffer;
  /** JSON schema of a robot file: descriptions and bounds of its keys. */
  robot_schema: Record<string, unknown>;
}

/** Workspace of a leg as closed outlines in B, which move with the body; empty if it has none there. */
export interface WorkspaceMessage {
  id: number;
  type: "workspace";
  leg: number;
  /** Points (x, y, z) of the outline on the ground. */
  ground_mm: number[];
  /** Points (x, y, z) of the outline in the present plane of the leg. */
  plane_mm: number[];
  /** Straight outward on the ground, from the coxa axis. */
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
  | SetCalibration
  | SetJoints
  | SetBody
  | DragFoot
  | SetWalk
  | SetLoads
  | SetPhysics
  | Simulate
  | SizeServos
  | ShowWorkspace
  | ChooseSource
  | Drive
  | Command
  | EndRun
  | BringUp
  | Answer
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
  | TerrainMessage
  | SimulatedMessage
  | DriveFrame
  | SourceMessage
  | BringUpMessage
  | CalibrationMessage
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
  /** The gait. Default: tripod; for four legs creep, for an odd number wave. */
  name?: "tripod" | "tetrapod" | "amble" | "ripple" | "wave" | "creep";
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
