//! Keys of `[control]` and of phases for the launch of a net.

use super::declared::{declared, number};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

declared! {
    DebrisNumbers = DEBRIS {
        launch_distance: f64 = LawParameter::number("launch_distance_m", "m",
            "Distance behind the debris at which the net is launched", Limit::Positive).or(&[10.0]);
        least_debris_speed: f64 = number("least_debris_speed_m_s", "m/s",
            "Speed of the debris below which its velocity does not define the launch axis", &[1e-3]);
        approach_axis: [f64; 3] = LawParameter::number("approach_axis", "1",
            "Launch axis below that speed, a direction in F_e along which s3 points; zero: the mission fails",
            Limit::Finite).with_components(&["x", "y", "z"]).or(&[0.0; 3]);
        keep_out: f64 = number("keep_out_m", "m", "Distance from the debris below which the mission fails", &[0.0]);
        lost_target_timeout: f64 = number("lost_target_timeout_s", "s",
            "How long the debris may go unmeasured before the mission fails; 0: forever", &[0.0]);
        plume_range: f64 = number("plume_range_m", "m",
            "Distance to the debris within which the plume of a thruster counts as hitting it", &[0.0]);
        plume_half_angle: f64 = number("plume_half_angle_rad", "rad", "Half angle of the cone of a plume", &[0.0]);
    }
}

declared! {
    TransferNumbers = TRANSFER {
        time: f64 = LawParameter::number("transfer_time_s", "s", "Time of the transfer to the station",
            Limit::Positive);
    }
}
