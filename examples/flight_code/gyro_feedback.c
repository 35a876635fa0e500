/* Feedback with the rate as the gyro measures it; where the star tracker is silent for too long, the rate alone. With measurements and telemetry: interface 2.
 *
 * clang --target=wasm32 -O2 -nostdlib -Wl,--no-entry -Wl,--strip-all -o gyro_feedback.wasm gyro_feedback.c */
#include "spindrift.h"

static struct spindrift_input in;
static struct spindrift_output out;
static struct { double stiffness, damping, patience; } numbers;
static struct { struct spindrift_measurement gyro, tracker; } measured; /* as in the table */
static struct { double error, age, trusted; } reported;

SPINDRIFT_EXPORT(spindrift_interface) int interface_number(void) { return SPINDRIFT_INTERFACE; }
SPINDRIFT_EXPORT(spindrift_input) struct spindrift_input *input(void) { return &in; }
SPINDRIFT_EXPORT(spindrift_output) struct spindrift_output *output(void) { return &out; }
SPINDRIFT_EXPORT(spindrift_parameters) void *parameters(void) { return &numbers; }
SPINDRIFT_EXPORT(spindrift_parameter_table) const char *parameter_table(void) {
    return "stiffness_n_m | N m   |     | Torque against twice the vector part of the attitude\n"
           "damping_n_m_s | N m s |     | Torque against a rate of 1 rad/s\n"
           "patience_s    | s     | 1.0 | Age of an attitude beyond which it is not used\n";
}
SPINDRIFT_EXPORT(spindrift_measurements) void *measurements(void) { return &measured; }
SPINDRIFT_EXPORT(spindrift_measurement_table) const char *measurement_table(void) {
    return "gyro    | rate_gyro\n"
           "tracker | star_tracker\n";
}
SPINDRIFT_EXPORT(spindrift_telemetry) void *telemetry(void) { return &reported; }
SPINDRIFT_EXPORT(spindrift_telemetry_table) const char *telemetry_table(void) {
    return "error_rad     | rad | Twice the length of the vector part of the estimated attitude relative to the target\n"
           "tracker_age_s | s   | Age of the attitude that the star tracker has measured last\n"
           "trusted       | 1   | Whether the attitude is used: 1 or 0\n";
}

SPINDRIFT_EXPORT(spindrift_step) void step(void) {
    const double sign = in.q_ts[0] < 0.0 ? -1.0 : 1.0; /* of the shorter rotation */
    const double age = measured.tracker.age_s;
    const double *rate = measured.gyro.age_s < 0.0 ? in.omega_se_s : measured.gyro.values;
    double square = 0.0;
    reported.age = age;
    reported.trusted = age >= 0.0 && age <= numbers.patience ? 1.0 : 0.0;
    for (int i = 0; i < 3; i++) {
        const double error = 2.0 * sign * in.q_ts[i + 1];
        square += error * error;
        out.torque_s[i] = -(reported.trusted * numbers.stiffness * error + numbers.damping * (rate[i] - in.omega_te_s[i]));
    }
    reported.error = __builtin_sqrt(square);
}
