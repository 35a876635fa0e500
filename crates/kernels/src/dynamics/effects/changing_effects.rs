//! `effects!`: the list of effects, and the structs of those that change within an arc.

/// Generates [`super::Effect`] and the structs from the list:
///
/// ```text
/// constant, of_orbit { Effect: form, key, condition; }
/// series { Effect: file, Series, [begin_arc, set_arc]?, key, condition; }
/// evaluated { Effect: file, [begin_arc, set_arc]?, key, condition; }
/// ```
///
/// An effect that changes within an arc is a type in `file` with `none(zero)`, `set_lane(lane, &Effect<f64>)` and
/// `torque(&Motion<R>)` in B, N m; constants of an arc (the dipole of the torque rods) are set by `begin_arc(dipole)`
/// and copied by `set_arc(lane, &Effect<f64>)`. The form `Evaluated` adds `force(&Motion<R>)` in B, N, and branches
/// ([`crate::ode::switches`]): `is_rough(zero)`, `switches(&[Motion<R>; M], visit)`, `choose_branches(lanes,
/// &Motion<R>)`. `Series<R>` has `new(zero, order)`, `NEEDS_POSITION`, `begin(&Effect<R>, time, unit)` and `extend(n,
/// &MotionSeries<R>)`, coefficient n of the torque in the unit of time, for ascending n. The file also has `of(zero,
/// scene, c_sb)`, the constants in the frame B (`c_sb` maps it to F_s) if the effect acts; `largest_torque(scene)`, an
/// upper bound, N m; `largest_rate(scene, torque)`, the fastest motion that a torque causes, rad/s.
macro_rules! effects {
    (
        constant { $($(#[$constant_doc:meta])* $Constant:ident: $constant_form:ident, $constant_key:literal,
            $constant_acts:expr;)* }
        series { $($(#[$series_doc:meta])* $Of:ident: $series:ident, $Series:ident, [$($of_arc:ident),*],
            $series_key:literal, $series_acts:expr;)* }
        evaluated { $($(#[$evaluated_doc:meta])* $Evaluated:ident: $evaluated:ident, [$($evaluated_arc:ident),*],
            $evaluated_key:literal, $evaluated_acts:expr;)* }
        of_orbit { $($(#[$orbit_doc:meta])* $OfOrbit:ident: $orbit_form:ident, $orbit_key:literal,
            $orbit_acts:expr;)* }
    ) => {
        changing_effects::effects! { enum {
            $($(#[$constant_doc])* $Constant: $constant_form, $constant_key, $constant_acts;)*
            $($(#[$series_doc])* $Of: Series, $series_key, $series_acts;)*
            $($(#[$evaluated_doc])* $Evaluated: Evaluated, $evaluated_key, $evaluated_acts;)*
            $($(#[$orbit_doc])* $OfOrbit: $orbit_form, $orbit_key, $orbit_acts;)*
        } }
        changing_effects::effects! {
            all { $($series: $Of, [$($of_arc),*];)* $($evaluated: $Evaluated, [$($evaluated_arc),*];)* }
        }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// True if an effect with branches acts.
            #[inline(always)]
            pub fn has_switches(&self) -> bool {
                false $(|| self.$evaluated.is_some())*
            }

            /// Lanes in which an effect is not smooth within its branches.
            #[inline(always)]
            pub fn is_rough(&self, zero: R) -> R::Mask {
                let mut rough = zero.never();
                $(
                    if let Some(effect) = &self.$evaluated {
                        rough = rough | effect.is_rough(zero);
                    }
                )*
                rough
            }

            /// Sum of the forces on the centre of mass, B, N, if they act on the orbit.
            #[inline(always)]
            pub fn force(&self, motion: &within_arcs::Motion<R>) -> Option<[R; 3]> {
                if !self.is_coupled {
                    return None;
                }
                let mut total = [motion.time.zero(); 3];
                $(
                    if let Some(effect) = &self.$evaluated {
                        total = $crate::math::vector::sum(total, effect.force(motion));
                    }
                )*
                Some(total)
            }

            /// Chooses the branches in the lanes `lanes`.
            #[inline(always)]
            pub fn choose_branches(&mut self, lanes: R::Mask, motion: &within_arcs::Motion<R>) {
                $(
                    if let Some(effect) = &mut self.$evaluated {
                        effect.choose_branches(lanes, motion);
                    }
                )*
            }

            /// Smallest switch function in the present branches.
            #[inline(always)]
            pub fn margin(&self, motion: &within_arcs::Motion<R>) -> R {
                let mut least = motion.time.splat(f64::INFINITY);
                self.switches(
                    &[*motion],
                    #[inline(always)]
                    |[margin]: [R; 1]| least = margin.smaller(least),
                );
                least
            }

            /// [`crate::ode::switches::dip`] of all switch functions.
            #[inline(always)]
            pub fn dip(&self, motions: &[within_arcs::Motion<R>; 4]) -> R {
                let mut first = motions[0].time.splat(f64::INFINITY);
                self.switches(
                    motions,
                    #[inline(always)]
                    |margins: [R; 4]| first = $crate::ode::switches::dip(margins).smaller(first),
                );
                first
            }

            /// Calls `visit` with each switch function at `M` states.
            #[inline(always)]
            fn switches<const M: usize>(&self, motions: &[within_arcs::Motion<R>; M], mut visit: impl FnMut([R; M])) {
                $(
                    if let Some(effect) = &self.$evaluated {
                        effect.switches(motions, &mut visit);
                    }
                )*
            }
        }

        /// Taylor series of the effects along a step.
        #[derive(Clone, Debug)]
        pub struct ChangingSeries<R> {
            /// Series of the motion on which they depend.
            pub motion: within_arcs::MotionSeries<R>,
            has_orbit: bool,
            keeps_orbit: bool,
            $($series: (bool, $series::$Series<R>),)*
            /// Sum of all torques on the body, B, N m in the unit of time.
            torque: Vec<[R; 3]>,
        }

        impl<R: $crate::math::Real> ChangingSeries<R> {
            /// Memory for series of order `order`.
            pub fn new(zero: R, order: usize) -> Self {
                ChangingSeries {
                    motion: within_arcs::MotionSeries::new(zero, order),
                    has_orbit: false,
                    keeps_orbit: false,
                    $($series: (false, $series::$Series::new(zero, order)),)*
                    torque: vec![[zero; 3]; order + 1],
                }
            }

            /// Keeps the coefficients of the orbit.
            pub fn with_orbit(self) -> Self {
                ChangingSeries { keeps_orbit: true, ..self }
            }

            /// Starts a step at `time` (s) in a unit of `unit` seconds. `place`: gravity and position on the orbit (m,
            /// m/s), if needed; `may_leave`: the spacecraft may leave it.
            #[inline(always)]
            pub fn begin(
                &mut self,
                acting: &ChangingEffects<R>,
                place: Option<&($crate::dynamics::gravity::Gravity<R>, $crate::dynamics::orbit_state::OrbitState<R>)>,
                may_leave: bool,
                time: R,
                unit: R,
            ) {
                self.has_orbit = place.is_some();
                if let Some((gravity, place)) = place {
                    let velocity = $crate::math::vector::scaled(unit, place.velocity);
                    let keeps_orbit = self.keeps_orbit
                        $(|| $series::$Series::<R>::NEEDS_POSITION && acting.$series.is_some())*;
                    self.motion.begin_orbit(
                        gravity.in_unit(unit),
                        [place.position, velocity],
                        may_leave,
                        keeps_orbit,
                    );
                }
                $(
                    self.$series.0 = acting.$series.is_some();
                    if let Some(effect) = &acting.$series {
                        self.$series.1.begin(effect, time, unit);
                    }
                )*
            }

            /// Coefficient n of the sum of the torques from those of attitude, rate and offset from the orbit (m), in
            /// ascending order of `n`; [`ChangingSeries::torque`] includes `constant`.
            #[inline(always)]
            pub fn extend(
                &mut self,
                n: usize,
                attitude: [R; 4],
                rate: [R; 3],
                offset: [R; 3],
                constant: [R; 3],
            ) -> [R; 3] {
                let mut own = [attitude[0].zero(); 3];
                if n == 0 || !self.motion.follows_rate() {
                    self.motion.attitude[n] = attitude;
                }
                self.motion.rate[n] = rate;
                if self.has_orbit {
                    self.motion.extend_orbit(n, offset);
                }
                $(
                    if self.$series.0 {
                        own = $crate::math::vector::sum(own, self.$series.1.extend(n, &self.motion));
                    }
                )*
                self.torque[n] = if n == 0 { $crate::math::vector::sum(constant, own) } else { own };
                own
            }

            /// Coefficients of the whole torque, B, N m in the unit of time.
            #[inline(always)]
            pub fn torque(&self) -> &[[R; 3]] {
                &self.torque
            }
        }
    };
    (enum { $($(#[$doc:meta])* $Effect:ident: $form:ident, $key:literal, $acts:expr;)* }) => {
        /// An effect.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Effect { $($(#[$doc])* $Effect,)* }

        impl Effect {
            /// All effects.
            pub const ALL: [Effect; [$($key),*].len()] = [$(Effect::$Effect),*];

            /// The key that activates it.
            pub const fn key(self) -> &'static str {
                match self { $(Effect::$Effect => $key,)* }
            }

            /// Its role in an engine.
            pub const fn form(self) -> Form {
                match self { $(Effect::$Effect => Form::$form,)* }
            }

            fn acts(self, facts: &Facts<'_>) -> bool {
                let acts: fn(&Facts<'_>) -> bool = match self { $(Effect::$Effect => $acts,)* };
                acts(facts)
            }
        }
    };
    (all { $($file:ident: $Constants:ident, [$($begin_arc:ident, $set_arc:ident)?];)* }) => {
        $(pub(crate) mod $file;)*

        /// Constants of the effects that change within an arc, one run per lane.
        #[derive(Clone, Copy, Debug)]
        pub struct ChangingEffects<R> {
            $(
                #[doc = concat!("The constants of `", stringify!($file), "`.")]
                pub $file: Option<$file::$Constants<R>>,
            )*
            /// True if their forces move the centre of mass.
            pub is_coupled: bool,
        }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// No effects.
            pub const fn none() -> Self {
                ChangingEffects { $($file: None,)* is_coupled: false }
            }

            /// The effects on `scene` in the frame B (`c_sb`: B -> F_s).
            pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Self {
                ChangingEffects { $($file: $file::of(zero, scene, c_sb),)* is_coupled: scene.environment.moves() }
            }

            /// True if no effect acts.
            pub fn is_empty(&self) -> bool {
                true $(&& self.$file.is_none())*
            }

            /// Copies the effects of `own` into lane `lane`.
            pub fn set_lane(&mut self, zero: R, lane: usize, own: &ChangingEffects<f64>) {
                $(
                    if let Some(own) = &own.$file {
                        self.$file.get_or_insert_with(|| $file::$Constants::none(zero)).set_lane(lane, own);
                    }
                )*
                // equal in all runs of a plan
                self.is_coupled |= own.is_coupled;
            }

            /// Starts an arc with the dipole `dipole()` of the torque rods, B, A m^2.
            #[inline(always)]
            pub fn begin_arc(&mut self, dipole: impl Fn() -> [R; 3]) {
                $($(
                    if let Some(effect) = &mut self.$file {
                        effect.$begin_arc(dipole());
                    }
                )?)*
            }

            /// Copies the constants of the present arc.
            #[inline(always)]
            pub fn set_arc(&mut self, lane: usize, own: &ChangingEffects<f64>) {
                $($(
                    if let (Some(effect), Some(own)) = (&mut self.$file, &own.$file) {
                        effect.$set_arc(lane, own);
                    }
                )?)*
            }

            /// Sum of the torques, B, N m.
            #[inline(always)]
            pub fn torque(&self, motion: &within_arcs::Motion<R>) -> [R; 3] {
                let mut total = [motion.time.zero(); 3];
                $(
                    if let Some(effect) = &self.$file {
                        total = $crate::math::vector::sum(total, effect.torque(motion));
                    }
                )*
                total
            }
        }

        /// Upper bound of the torque of these effects on `scene`, N m.
        pub fn largest_changing_torque(scene: &Scene) -> f64 {
            0.0 $(+ $file::largest_torque(scene))*
        }

        /// The fastest motion that these effects cause on `scene`, rad/s.
        pub fn largest_changing_rate(scene: &Scene) -> f64 {
            let mut largest = 0.0_f64;
            $(largest = largest.max($file::largest_rate(scene, $file::largest_torque(scene)));)*
            largest
        }
    };
}
pub(super) use effects;
