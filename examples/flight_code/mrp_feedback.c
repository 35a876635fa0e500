/* MRP feedback with an integral (H. Schaub & J. L. Junkins, Analytical Mechanics of Space Systems, 2018, section 8.4), operation by operation as the built-in
 * law mrp_feedback has it, so that rows have the same bits.
 *
 * clang --target=wasm32 -O2 -nostdlib -Wl,--no-entry -Wl,--strip-all -o mrp_feedback_c.wasm mrp_feedback.c */
#include "spindrift.h"

static struct spindrift_input in;
static struct spindrift_output out;
static struct { double stiffness, damping, integral, integral_limit; } numbers;
static double summed[3]; /* the integral of K s, N m s */

SPINDRIFT_EXPORT(spindrift_interface) int interface_number(void) { return 1; }
SPINDRIFT_EXPORT(spindrift_input) struct spindrift_input *input(void) { return &in; }
SPINDRIFT_EXPORT(spindrift_output) struct spindrift_output *output(void) { return &out; }
SPINDRIFT_EXPORT(spindrift_parameters) void *parameters(void) { return &numbers; }
SPINDRIFT_EXPORT(spindrift_parameter_table) const char *parameter_table(void) {
    return "stiffness_n_m        | N m         |   | Torque against an MRP of one: K\n"
           "damping_n_m_s        | N m s       |   | Torque against a rate of 1 rad/s: P\n"
           "integral_1_n_m_s     | 1/(N m s)   | 0 | Gain of the integral: Ki\n"
           "integral_limit_n_m_s | N m s       | 0 | Largest magnitude of each component of the integral of K s; 0: no limit\n";
}

static void cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void product(const double m[3][3], const double a[3], double c[3]) {
    for (int i = 0; i < 3; i++) c[i] = m[i][0] * a[0] + m[i][1] * a[1] + m[i][2] * a[2];
}

static double limited(double x, double limit) {
    return limit == 0.0 ? x : x < -limit ? -limit : x > limit ? limit : x;
}

SPINDRIFT_EXPORT(spindrift_step) void step(void) {
    double mrp[3], relative[3], torque[3], rate[3], carried[3], ahead[3], gyroscopic[3];
    const double sign = in.q_ts[0] < 0.0 ? -1.0 : 1.0; /* of the shorter rotation */
    const double factor = 1.0 / (1.0 + sign * in.q_ts[0]);
    for (int i = 0; i < 3; i++) {
        mrp[i] = factor * (sign * in.q_ts[i + 1]);
        relative[i] = in.omega_se_s[i] - in.omega_te_s[i];
        torque[i] = numbers.stiffness * mrp[i] + numbers.damping * relative[i];
        rate[i] = in.omega_te_s[i];
    }
    if (numbers.integral > 0.0) {
        product(in.inertia_kg_m2, relative, ahead);
        for (int i = 0; i < 3; i++) {
            summed[i] = limited(summed[i] + numbers.stiffness * in.elapsed_s * mrp[i], numbers.integral_limit);
            const double z = summed[i] + ahead[i];
            torque[i] = torque[i] + numbers.damping * numbers.integral * z;
            rate[i] = rate[i] + numbers.integral * z;
        }
    }
    cross(in.omega_se_s, in.omega_te_s, carried);
    for (int i = 0; i < 3; i++) carried[i] -= in.acceleration_te_s[i];
    product(in.inertia_kg_m2, carried, ahead);
    cross(rate, in.momentum_s, gyroscopic);
    for (int i = 0; i < 3; i++) out.torque_s[i] = -1.0 * (torque[i] + (ahead[i] - gyroscopic[i]));
}
