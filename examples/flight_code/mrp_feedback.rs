//! MRP feedback, as `mrp_feedback.c`, in Rust.
//!
//! rustc --edition 2024 --target wasm32-unknown-unknown --crate-type cdylib -O -C panic=abort -C strip=symbols -o
//! mrp_feedback_rust.wasm mrp_feedback.rs
#![no_std]

use core::cell::UnsafeCell;

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}

/// What is known at a tick: `struct spindrift_input` of `spindrift.h`.
#[repr(C)]
struct Input {
    time: f64,
    elapsed: f64,
    period: f64,
    delay: f64,
    q_ts: [f64; 4],
    omega_se_s: [f64; 3],
    omega_te_s: [f64; 3],
    acceleration_te_s: [f64; 3],
    momentum_s: [f64; 3],
    inertia: [[f64; 3]; 3],
    q_es: [f64; 4],
    gyro_bias_s: [f64; 3],
    r_co_e: [f64; 3],
    v_co_e: [f64; 3],
    wheel_rates: [f64; 8],
}

#[repr(C)]
struct Parameters {
    stiffness: f64,
    damping: f64,
    integral: f64,
    integral_limit: f64,
}

/// A place in memory that is shared with the loop.
struct Shared<T>(UnsafeCell<T>);

// a module has one thread
unsafe impl<T> Sync for Shared<T> {}

impl<T> Shared<T> {
    /// All of its numbers are zero.
    const fn zero() -> Self {
        // numbers of all bits zero are zero
        Shared(UnsafeCell::new(unsafe { core::mem::zeroed() }))
    }
}

static INPUT: Shared<Input> = Shared::zero();
static OUTPUT: Shared<[f64; 3]> = Shared::zero();
static PARAMETERS: Shared<Parameters> = Shared::zero();
/// The integral of K s, N m s.
static SUMMED: Shared<[f64; 3]> = Shared::zero();

const TABLE: &str = "stiffness_n_m | N m | | Torque against an MRP of one: K
damping_n_m_s | N m s | | Torque against a rate of 1 rad/s: P
integral_1_n_m_s | 1/(N m s) | 0 | Gain of the integral: Ki
integral_limit_n_m_s | N m s | 0 | Largest magnitude of each component of the integral of K s; 0: no limit
\0";

#[unsafe(no_mangle)]
extern "C" fn spindrift_interface() -> i32 {
    1
}

#[unsafe(no_mangle)]
extern "C" fn spindrift_input() -> *mut Input {
    INPUT.0.get()
}

#[unsafe(no_mangle)]
extern "C" fn spindrift_output() -> *mut [f64; 3] {
    OUTPUT.0.get()
}

#[unsafe(no_mangle)]
extern "C" fn spindrift_parameters() -> *mut Parameters {
    PARAMETERS.0.get()
}

#[unsafe(no_mangle)]
extern "C" fn spindrift_parameter_table() -> *const u8 {
    TABLE.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn spindrift_step() {
    // nobody else has them during a step
    let (input, numbers, summed) = unsafe { (&*INPUT.0.get(), &*PARAMETERS.0.get(), &mut *SUMMED.0.get()) };
    let torque = torque(input, numbers, summed);
    unsafe { *OUTPUT.0.get() = torque };
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn product(m: &[[f64; 3]; 3], a: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * a[0] + row[1] * a[1] + row[2] * a[2])
}

fn torque(input: &Input, numbers: &Parameters, summed: &mut [f64; 3]) -> [f64; 3] {
    let [w, x, y, z] = if input.q_ts[0] < 0.0 { input.q_ts.map(|component| -component) } else { input.q_ts };
    let mrp = [x, y, z].map(|component| 1.0 / (1.0 + w) * component);
    let relative: [f64; 3] = core::array::from_fn(|i| input.omega_se_s[i] - input.omega_te_s[i]);
    let mut torque: [f64; 3] = core::array::from_fn(|i| numbers.stiffness * mrp[i] + numbers.damping * relative[i]);
    let mut rate = input.omega_te_s;
    if numbers.integral > 0.0 {
        let limit = if numbers.integral_limit == 0.0 { f64::INFINITY } else { numbers.integral_limit };
        let turning = product(&input.inertia, relative);
        for i in 0..3 {
            summed[i] = (summed[i] + numbers.stiffness * input.elapsed * mrp[i]).max(-limit).min(limit);
            let z = summed[i] + turning[i];
            torque[i] += numbers.damping * numbers.integral * z;
            rate[i] += numbers.integral * z;
        }
    }
    let turned = cross(input.omega_se_s, input.omega_te_s);
    let ahead = product(&input.inertia, core::array::from_fn(|i| turned[i] - input.acceleration_te_s[i]));
    let gyroscopic = cross(rate, input.momentum_s);
    core::array::from_fn(|i| -(torque[i] + (ahead[i] - gyroscopic[i])))
}
