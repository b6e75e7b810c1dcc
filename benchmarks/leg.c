// The inverse kinematics of `tarsus.inverse_kinematics` as a C loop, the reference of the benchmarks.
//
// Input feet (robots, legs, 3); output angles (robots, legs, 3) and reach codes (robots, legs), in the layouts of Tarsus.
// Per leg 3 atan2 and 2 sqrt; legs that can't reach are solved again with the leg's plane reversed and, failing that, for
// the nearest reachable point. For femur axes without sideways offset.
//
// Robots are processed in small blocks, leg by leg, so that the compiler vectorises each inner loop (with the vector
// mathematics library of glibc where available).

#include <math.h>
#include <stdint.h>

#define N 128        // robots in a block
#define LEGS 6
#define CONSTANTS 18 // numbers per leg, in the order of `struct leg`

struct leg {
    double x, y, z, cos_yaw, sin_yaw;                     // mount; z is the femur axis'
    double coxa, femur, tibia;
    double farthest2, nearest2, sum2, difference2;
    double lower[3], upper[3];
};

struct body { // of all robots in a block, side by side
    double r[9][N], p[3][N];
};

enum { OK, TOO_FAR, TOO_NEAR, COXA_LIMIT, FEMUR_LIMIT, TIBIA_LIMIT, BELOW_GROUND };

#define INLINE static inline __attribute__((always_inline))

static const double LENGTH = 1e-13, ANGLE = 1e-9, PI = 3.14159265358979323846;

INLINE double lesser(double a, double b) { return a < b ? a : b; }
INLINE double greater(double a, double b) { return a > b ? a : b; }
INLINE int outside(double q, double lower, double upper) {
    return (q < lower - ANGLE) | (q > upper + ANGLE);
}

// The triangle of femur, tibia and the line to the foot; `facing` is 1, or -1 for the plane turned away.
INLINE int solve(const struct leg *g, double facing, double x, double y, double z, double q[3]) {
    double along = facing * sqrt(x * x + y * y), r = along - g->coxa;
    double distance2 = r * r + z * z, far = g->farthest2 - distance2, near = distance2 - g->nearest2;
    double height = sqrt(greater(far * near, 0.0)), base = distance2 + g->difference2;
    double slack = 2 * LENGTH * (g->femur + g->tibia);
    q[0] = atan2(facing * y, facing * x);
    q[1] = atan2(z * base + r * height, r * base - z * height);
    q[2] = -atan2(height, distance2 - g->sum2);
    int code = OK;
    code = outside(q[2], g->lower[2], g->upper[2]) ? TIBIA_LIMIT : code;
    code = outside(q[1], g->lower[1], g->upper[1]) ? FEMUR_LIMIT : code;
    code = outside(q[0], g->lower[0], g->upper[0]) ? COXA_LIMIT : code;
    code = near < -slack ? TOO_NEAR : code;
    code = far < -slack ? TOO_FAR : code;
    return code;
}

// glibc has vector forms of sin and cos but not of the sincos that gcc makes of the two; this keeps them apart.
INLINE double sine(double q) { return cos(q - PI / 2); }

INLINE double wrap(double q) { return q - 2 * PI * nearbyint(q / (2 * PI)); }

INLINE double clip(double q, double lower, double upper) {
    double nearer = fabs(wrap(lower - q)) < fabs(wrap(q - upper)) ? lower : upper;
    return (q >= lower) & (q <= upper) ? q : nearer;
}

struct best {
    double miss2, q[3];
};

// Keep a candidate where its foot (in the plane turned to `coxa`, `off` beside it) is nearer than the best so far.
INLINE void consider(const struct leg *g, double coxa, double r, double z, double off, double q1, double q2,
                            struct best *best) {
    double miss_r = g->femur * cos(q1) + g->tibia * cos(q1 + q2) - r;
    double miss_z = g->femur * sine(q1) + g->tibia * sine(q1 + q2) - z;
    double miss2 = miss_r * miss_r + miss_z * miss_z + off * off;
    int closer = miss2 < best->miss2;
    best->miss2 = closer ? miss2 : best->miss2;
    best->q[0] = closer ? coxa : best->q[0];
    best->q[1] = closer ? q1 : best->q[1];
    best->q[2] = closer ? q2 : best->q[2];
}

INLINE double clip_femur(const struct leg *g, double q) { return clip(wrap(q), g->lower[1], g->upper[1]); }
INLINE double clip_tibia(const struct leg *g, double q) { return clip(wrap(q), g->lower[2], g->upper[2]); }

INLINE void femur_at(const struct leg *g, double coxa, double r, double z, double off, double femur, struct best *best) {
    double knee_r = g->femur * cos(femur), knee_z = g->femur * sine(femur);
    consider(g, coxa, r, z, off, femur, clip_tibia(g, atan2(z - knee_z, r - knee_r) - femur), best);
}

INLINE void tibia_at(const struct leg *g, double coxa, double r, double z, double off, double direction, double tibia,
                     struct best *best) {
    double inside = atan2(g->tibia * sine(tibia), g->femur + g->tibia * cos(tibia));
    consider(g, coxa, r, z, off, clip_femur(g, direction - inside), tibia, best);
}

INLINE void nearest_in_plane(const struct leg *g, double coxa, double x, double y, double z, struct best *best) {
    double c = cos(coxa), s = sine(coxa), r = x * c + y * s - g->coxa, off = y * c - x * s;
    double direction = atan2(z, r), distance2 = r * r + z * z;
    double height = sqrt(greater((g->farthest2 - distance2) * (distance2 - g->nearest2), 0.0));
    consider(g, coxa, r, z, off, clip_femur(g, direction + atan2(height, distance2 + g->difference2)),
             clip_tibia(g, -atan2(height, distance2 - g->sum2)), best);
    femur_at(g, coxa, r, z, off, g->lower[1], best);
    femur_at(g, coxa, r, z, off, g->upper[1], best);
    tibia_at(g, coxa, r, z, off, direction, g->lower[2], best);
    tibia_at(g, coxa, r, z, off, direction, g->upper[2], best);
}

// Try the legs that failed once more: turned away, or the nearest point. `upper[2]` is cut to the knee-up branch.
static void second_tries(const struct leg *g, int n, const double *x, const double *y, const double *z, double (*q)[N],
                         int *code) {
    struct leg up = *g;
    if (up.lower[2] <= 0)
        up.upper[2] = lesser(up.upper[2], 0.0);
    double away[3][N], miss2[N];
    int away_code[N];
    for (int i = 0; i < n; i++) {
        double one[3];
        away_code[i] = solve(g, -1.0, x[i], y[i], z[i], one);
        away[0][i] = one[0], away[1][i] = one[1], away[2][i] = one[2];
    }
    for (int i = 0; i < n; i++) {
        struct best best = {1e300, {0, 0, 0}};
        nearest_in_plane(&up, clip(atan2(y[i], x[i]), g->lower[0], g->upper[0]), x[i], y[i], z[i], &best);
        nearest_in_plane(&up, clip(atan2(-y[i], -x[i]), g->lower[0], g->upper[0]), x[i], y[i], z[i], &best);
        q[0][i] = best.q[0], q[1][i] = best.q[1], q[2][i] = best.q[2];
        miss2[i] = best.miss2;
    }
    for (int i = 0; i < n; i++)
        if (miss2[i] <= LENGTH * LENGTH)
            code[i] = OK;
    for (int i = 0; i < n; i++)
        if (away_code[i] == OK)
            q[0][i] = away[0][i], q[1][i] = away[1][i], q[2][i] = away[2][i], code[i] = OK;
}

// Mark the legs whose attachment is below the ground, and those within reach whose femur axis or knee is.
static void mark_below(const struct leg *g, double up, const struct body *b, int n, double (*q)[N], int *code) {
    for (int i = 0; i < n; i++) {
        double c = cos(q[0][i]), s = sine(q[0][i]);
        double out_x = g->cos_yaw * c - g->sin_yaw * s, out_y = g->sin_yaw * c + g->cos_yaw * s;
        double knee_r = g->coxa + g->femur * cos(q[1][i]), knee_z = g->z + g->femur * sine(q[1][i]);
        double zx = b->r[6][i], zy = b->r[7][i], zz = b->r[8][i], h = b->p[2][i];
        double mount = zx * g->x + zy * g->y + h, outward = zx * out_x + zy * out_y;
        int attachment = mount + zz * (g->z - up) < -LENGTH;
        int axis = mount + g->coxa * outward + zz * g->z < -LENGTH;
        int knee = mount + knee_r * outward + zz * knee_z < -LENGTH;
        code[i] = attachment | ((code[i] == OK) & (axis | knee)) ? BELOW_GROUND : code[i];
    }
}

// Whether no point of a leg but the foot can be below the ground, from the bodies' heights and the lowest femur.
static int surely_above(const struct leg *g, const struct body *b, int n, double lowest_femur) {
    double height = 1e300, lean2 = 0, zz = 1;
    for (int i = 0; i < n; i++) {
        height = lesser(height, b->p[2][i]);
        lean2 = greater(lean2, b->r[6][i] * b->r[6][i] + b->r[7][i] * b->r[7][i]);
        zz = lesser(zz, b->r[8][i]);
    }
    double span = sqrt(g->x * g->x + g->y * g->y) + g->coxa + g->femur;
    double drop = lowest_femur >= 0 ? 0 : lowest_femur > -PI / 2 ? sine(-lowest_femur) : 1;
    return zz >= 0 && height > sqrt(lean2) * span + drop * g->femur + fabs(g->z);
}

static void load_bodies(struct body *b, int n, const double *rotation, const double *position) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < 9; j++)
            b->r[j][i] = rotation[9 * i + j];
        for (int j = 0; j < 3; j++)
            b->p[j][i] = position[3 * i + j];
    }
}

static void solve_leg(const struct leg *g, double up, const struct body *b, int n, const double *feet, double *angles,
                      int8_t *codes) {
    double x[N], y[N], z[N], q[3][N], lowest = 0;
    int code[N], bad = 0;
    for (int i = 0; i < n; i++) {
        const double *foot = feet + 3 * LEGS * i;
        x[i] = foot[0], y[i] = foot[1], z[i] = foot[2];
    }
    for (int i = 0; i < n; i++) {
        double px = x[i], py = y[i], pz = z[i];
        if (b) {
            double gx = px - b->p[0][i], gy = py - b->p[1][i], gz = pz - b->p[2][i];
            px = b->r[0][i] * gx + b->r[3][i] * gy + b->r[6][i] * gz;
            py = b->r[1][i] * gx + b->r[4][i] * gy + b->r[7][i] * gz;
            pz = b->r[2][i] * gx + b->r[5][i] * gy + b->r[8][i] * gz;
        }
        px -= g->x, py -= g->y, pz -= g->z;
        x[i] = g->cos_yaw * px + g->sin_yaw * py;
        y[i] = g->cos_yaw * py - g->sin_yaw * px;
        z[i] = pz;
    }
    for (int i = 0; i < n; i++) {
        double one[3];
        code[i] = solve(g, 1.0, x[i], y[i], z[i], one);
        q[0][i] = one[0], q[1][i] = one[1], q[2][i] = one[2];
        lowest = lesser(lowest, one[1]);
        bad |= code[i];
    }
    if (bad) {
        double bx[N], by[N], bz[N], bq[3][N];
        int bad_code[N], where[N], m = 0;
        for (int i = 0; i < n; i++)
            if (code[i])
                bx[m] = x[i], by[m] = y[i], bz[m] = z[i], bad_code[m] = code[i], where[m++] = i;
        second_tries(g, m, bx, by, bz, bq, bad_code);
        for (int i = 0; i < m; i++) {
            for (int j = 0; j < 3; j++)
                q[j][where[i]] = bq[j][i];
            code[where[i]] = bad_code[i];
            lowest = lesser(lowest, bq[1][i]);
        }
    }
    if (b && !surely_above(g, b, n, lowest))
        mark_below(g, up, b, n, q, code);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < 3; j++)
            angles[3 * LEGS * i + j] = q[j][i];
        codes[LEGS * i] = (int8_t)code[i];
    }
}

// `up`: the femur axes' height over the mounts. `rotation` (robots, 3, 3) and `position` (robots, 3) may be null.
void inverse(const double *constants, double up, long robots, const double *feet, const double *rotation,
             const double *position, double *angles, int8_t *codes) {
    struct body bodies;
    for (long start = 0; start < robots; start += N) {
        int n = robots - start < N ? (int)(robots - start) : N;
        if (rotation)
            load_bodies(&bodies, n, rotation + 9 * start, position + 3 * start);
        for (int leg = 0; leg < LEGS; leg++) {
            const struct leg *g = (const struct leg *)(constants + CONSTANTS * leg);
            long at = LEGS * start + leg;
            solve_leg(g, up, rotation ? &bodies : 0, n, feet + 3 * at, angles + 3 * at, codes + at);
        }
    }
}
