//! `changing_effects`: the effects that change within an arc as the equations of motion have them, from the list in the
//! parent module.

/// The effects that change within an arc, from the list of their files: those of the form `Series`, then those of the
/// form `Evaluated`:
///
/// ```text
/// series { file: Constants, Series; }
/// evaluated { file: Constants; }
/// ```
///
/// `Constants<R>` has `NEEDS_ORBIT`, `none(zero)`, `set_lane(lane, &Constants<f64>)` and `torque(&Motion<R>)`, in B, N
/// m; those of the form `Evaluated` have a force too, `force(&Motion<R>)`, in B, N, and branches
/// ([`crate::ode::switches`]): `is_rough(zero)`, `switches(&[Motion<R>; M], visit)` and `choose_branches(lanes,
/// &Motion<R>)`. `Series<R>` has `new(zero, order)`, `NEEDS_POSITION`, `begin(&Constants<R>, time, unit)` and
/// `extend(n, &MotionSeries<R>)`, coefficient n of the torque in the unit of time. The file has `of(zero, scene,
/// c_sb)`, the constants in the frame B that `c_sb` maps to F_s, `None` where the effect does not act;
/// `largest_torque(scene)`, an upper bound, N m; and `largest_rate(scene)`, the fastest motion that it makes, rad/s.
macro_rules! changing_effects {
    (series { $($series:ident: $Of:ident, $Series:ident;)* } evaluated { $($evaluated:ident: $Evaluated:ident;)* }) => {
        changing_effects::changing_effects! { all { $($series: $Of;)* $($evaluated: $Evaluated;)* } }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// Whether one acts that has branches.
            #[inline(always)]
            pub fn has_switches(&self) -> bool {
                false $(|| self.$evaluated.is_some())*
            }

            /// Where one is not smooth even within its branches.
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

            /// The sum of their forces, B, N, where they move the centre of mass.
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

            /// The smallest of the switch functions in their branches.
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

            /// The fraction of a step at which one of them may be below zero that is above at both ends
            /// ([`crate::ode::switches::dip`]).
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

            /// Gives `visit` each switch function in its branch, in `M` states.
            #[inline(always)]
            fn switches<const M: usize>(&self, motions: &[within_arcs::Motion<R>; M], mut visit: impl FnMut([R; M])) {
                $(
                    if let Some(effect) = &self.$evaluated {
                        effect.switches(motions, &mut visit);
                    }
                )*
            }
        }

        /// The Taylor series of the effects along a step.
        #[derive(Clone, Debug)]
        pub struct ChangingSeries<R> {
            /// What they depend on.
            pub motion: within_arcs::MotionSeries<R>,
            has_orbit: bool,
            keeps_orbit: bool,
            $($series: (bool, $series::$Series<R>),)*
            /// Of all torques on the body, B, N m in the unit of time.
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

            /// The same, which has the coefficients of an orbit in any case: it is integrated by them.
            pub fn with_orbit(self) -> Self {
                ChangingSeries { keeps_orbit: true, ..self }
            }

            /// Starts a step of `acting` at `time` (s) in a unit of time of `unit` seconds. `place` is the gravity of
            /// the central body and where the orbit is then (m, m/s), where it is needed; the spacecraft may leave it
            /// where `may_leave`.
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
                    let asks = self.keeps_orbit
                        $(|| $series::$Series::<R>::NEEDS_POSITION && acting.$series.is_some())*;
                    self.motion.begin_orbit(gravity.in_unit(unit), [place.position, velocity], may_leave, asks);
                }
                $(
                    self.$series.0 = acting.$series.is_some();
                    if let Some(effect) = &acting.$series {
                        self.$series.1.begin(effect, time, unit);
                    }
                )*
            }

            /// Coefficient n of the sum of the torques, given those of the motion: attitude, rate and offset from the
            /// orbit (m); call in ascending order of `n`. `constant` is what acts beside them, for
            /// [`ChangingSeries::torque`].
            #[inline(always)]
            pub fn extend(
                &mut self,
                n: usize,
                (attitude, rate, offset): ([R; 4], [R; 3], [R; 3]),
                constant: [R; 3],
            ) -> [R; 3] {
                let mut own = [attitude[0].zero(); 3];
                self.motion.attitude[n] = attitude;
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

            /// The coefficients of the torque, with what acts beside it, B, N m in the unit of time.
            #[inline(always)]
            pub fn torque(&self) -> &[[R; 3]] {
                &self.torque
            }
        }
    };
    (all { $($file:ident: $Constants:ident;)* }) => {
        /// The constants of the effects that change within an arc, one run per lane; `None` of those that do not act.
        #[derive(Clone, Copy, Debug)]
        pub struct ChangingEffects<R> {
            $(
                #[doc = concat!("That of `", stringify!($file), "`.")]
                pub $file: Option<$file::$Constants<R>>,
            )*
            /// Whether their forces move the centre of mass.
            pub is_coupled: bool,
        }

        impl<R: $crate::math::Real> ChangingEffects<R> {
            /// None.
            pub const fn none() -> Self {
                ChangingEffects { $($file: None,)* is_coupled: false }
            }

            /// Those on `scene` in the frame B, which `c_sb` maps to F_s; `zero` says in which arithmetic.
            pub fn of(zero: R, scene: &Scene, c_sb: Option<[[R; 3]; 3]>) -> Self {
                ChangingEffects { $($file: $file::of(zero, scene, c_sb),)* is_coupled: scene.environment.moves() }
            }

            /// Whether none acts.
            pub fn is_empty(&self) -> bool {
                true $(&& self.$file.is_none())*
            }

            /// Whether one acts that depends on where the spacecraft is.
            pub fn needs_orbit(&self) -> bool {
                false $(|| $file::$Constants::<R>::NEEDS_ORBIT && self.$file.is_some())*
            }

            /// Puts `own` into lane `lane` of as many as `zero` has.
            pub fn set_lane(&mut self, zero: R, lane: usize, own: &ChangingEffects<f64>) {
                $(
                    if let Some(own) = &own.$file {
                        self.$file.get_or_insert_with(|| $file::$Constants::none(zero)).set_lane(lane, own);
                    }
                )*
                // the same in all runs of a plan
                self.is_coupled |= own.is_coupled;
            }

            /// The sum of their torques, B, N m.
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

        /// Upper bound of the torque of the effects on `scene` that change within an arc, N m.
        pub fn largest_changing_torque(scene: &Scene) -> f64 {
            0.0 $(+ $file::largest_torque(scene))*
        }

        /// The fastest motion that the effects on `scene` make which change within an arc, rad/s.
        pub fn largest_changing_rate(scene: &Scene) -> f64 {
            let mut largest = 0.0_f64;
            $(largest = largest.max($file::largest_rate(scene));)*
            largest
        }
    };
}
pub(super) use changing_effects;
