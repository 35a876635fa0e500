/* Interface 2 between spindrift and flight code in a WebAssembly module: docs/flight-code.md. A module without measurements and telemetry may say 1.
 *
 * Vectors have components in the frame of their last letter: F_s is the body's, F_e the inertial one, F_t the target's. Quaternions are Hamilton's, scalar first;
 * q_ts maps F_s to F_t. Units are SI. */
#ifndef SPINDRIFT_H
#define SPINDRIFT_H

#define SPINDRIFT_INTERFACE 2
#define SPINDRIFT_EXPORT(name) __attribute__((export_name(#name)))

/* What is known at a tick. */
struct spindrift_input {
    double time_s;                 /* since the start of the run */
    double elapsed_s;              /* since the last step of the phase; 0 at the first */
    double period_s;               /* control period */
    double delay_s;                /* from a tick to the action of its commands */
    double q_ts[4];                /* attitude relative to the target, of either sign */
    double omega_se_s[3];          /* rate of the body, rad/s */
    double omega_te_s[3];          /* rate of the target, rad/s */
    double acceleration_te_s[3];   /* its derivative in F_e, rad/s^2 */
    double momentum_s[3];          /* angular momentum with the wheels, N m s */
    double inertia_kg_m2[3][3];    /* without the axial inertias of free wheels, as flight software knows it */
    double q_es[4];                /* attitude */
    double gyro_bias_s[3];         /* bias of the gyro, rad/s */
    double r_co_e[3];              /* position of the centre of mass, m */
    double v_co_e[3];              /* its velocity, m/s */
    double wheel_rates_rad_s[8];   /* of the wheels that turn, relative to the body; 0 beyond the last */
};

/* What is wanted of it. */
struct spindrift_output {
    double torque_s[3];            /* torque on the body, N m */
};

/* What a sensor of spindrift_measurement_table has delivered last. */
struct spindrift_measurement {
    double age_s;                  /* time since it was measured; -1 while the sensor has delivered nothing */
    double values[12];             /* in the order of its columns in `simulate`; NaN where one is not known, 0 beyond the last */
};

#endif
