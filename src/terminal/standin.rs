//! Private stand-in until simulator and coach land. Removed after the merge.
#![allow(missing_docs, clippy::all, clippy::pedantic)]
use std::{sync::{Arc, atomic::AtomicBool}, time::Duration};
use glam::DVec2;
use crate::{physics::*, simulation::{Event, EventKind, Rail}, table::{Layout, LayoutError, Table}};

#[derive(Debug)]
pub struct Recording { table: Table, samples: Vec<[BallState; 3]>, events: Vec<Event> }
const DT: f64 = 0.0005;
const KEEP: usize = 4;

impl Recording {
    pub fn new(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, CueError> {
        cue.validate()?;
        let mut b = layout.balls.map(BallState::at_rest);
        let i = strike(table, cue);
        b[0].velocity = i.velocity; b[0].spin = i.spin;
        let mut samples = vec![b];
        let mut events = vec![];
        let r = table.radius;
        let mut sliding = [true, false, false];
        let mut moving = [true, false, false];
        for n in 0..400_000 {
            let t = n as f64 * DT;
            for k in 0..3 {
                let s = slip(r, b[k].velocity, b[k].spin);
                if s.length() > 0.02 {
                    sliding[k] = true; moving[k] = true;
                    let a = -table.sliding_friction * table.gravity * s.normalize();
                    b[k].velocity += a * DT;
                    let c = 2.5 / r * table.sliding_friction * table.gravity;
                    let u = s.normalize();
                    b[k].spin.x += c * -u.y * DT; b[k].spin.y += c * u.x * DT;
                } else {
                    if sliding[k] && b[k].velocity.length() > 0.0 { sliding[k] = false; events.push(Event { time: t, kind: EventKind::SlidingRolling(k) }); }
                    let v = b[k].velocity.length();
                    let d = rolling_deceleration(table) * DT;
                    if v <= d { if moving[k] { moving[k] = false; events.push(Event { time: t, kind: EventKind::RollingStationary(k) }); } b[k].velocity = DVec2::ZERO; }
                    else { b[k].velocity *= (v - d) / v; moving[k] = true; }
                    let w = rolling_spin(r, b[k].velocity);
                    b[k].spin.x = w.x; b[k].spin.y = w.y;
                }
                b[k].spin.z = decayed_spin(b[k].spin.z, spin_deceleration(table), DT);
                b[k].position = b[k].position + b[k].velocity * DT;
                for rail in Rail::ALL {
                    let nn = rail.normal();
                    let lim = if nn.x != 0.0 { table.half_length() } else { table.half_width() };
                    if b[k].position.dot(nn) < -lim && b[k].velocity.dot(nn) < 0.0 {
                        collide_rail(r, table.rail_restitution, table.rail_friction, nn, &mut b[k]);
                        events.push(Event { time: t, kind: EventKind::BallRail(k, rail) });
                    }
                }
            }
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                if b[i].position.distance(b[j].position) < 2.0 * r {
                    let (mut x, mut y) = (b[i], b[j]);
                    if collide_balls(r, table.ball_restitution, table.ball_friction, &mut x, &mut y) > 0.0 {
                        b[i] = x; b[j] = y;
                        events.push(Event { time: t, kind: EventKind::BallBall(i, j) });
                    }
                }
            }
            if n % KEEP == KEEP - 1 { samples.push(b); }
            if b.iter().all(|x| x.velocity.length() == 0.0 && slip(r, x.velocity, x.spin).length() < 0.02) { break; }
        }
        samples.push(b);
        Ok(Self { table: table.clone(), samples, events })
    }
    pub fn events(&self) -> &[Event] { &self.events }
    pub fn duration(&self) -> f64 { (self.samples.len() - 1) as f64 * DT * KEEP as f64 }
    pub fn state(&self, ball: usize, t: f64) -> BallState { self.samples[((t / DT / KEEP as f64) as usize).min(self.samples.len() - 1)][ball] }
    pub fn motion(&self, ball: usize, t: f64) -> Motion {
        let s = self.state(ball, t);
        if s.velocity.length() == 0.0 { Motion::Stationary } else if slip(self.table.radius, s.velocity, s.spin).length() > 0.02 { Motion::Sliding } else { Motion::Rolling }
    }
    pub fn positions(&self, t: f64) -> [DVec2; 3] { [0, 1, 2].map(|b| self.state(b, t).position) }
    pub fn final_layout(&self) -> Layout { Layout::new(self.positions(self.duration())) }
}

#[derive(Debug)]
pub struct Coach(Table);
#[derive(Debug, Default, Clone)]
pub struct Request { pub budget: Duration, pub seed: u64, pub cancel: Arc<AtomicBool> }
#[derive(Debug, Clone)]
pub struct Recommendation { pub cue: CueInputs, pub solved: bool, pub source: &'static str, pub simulations: u64, pub elapsed: Duration, pub policy_success: Option<f64> }
impl Coach {
    pub fn new(table: Table) -> Result<Self, std::io::Error> { Ok(Self(table)) }
    pub fn recommend(&self, layout: &Layout, request: &Request) -> Result<Recommendation, LayoutError> {
        layout.validate(&self.0)?;
        let _ = &request.cancel;
        let d = layout.balls[1] - layout.balls[0];
        let phi = d.to_angle() + (0.6 * 2.0 * self.0.radius / d.length()).asin();
        Ok(Recommendation { cue: CueInputs { a: -0.12, b: 0.21, theta: 0.08, phi, speed: 2.5 }, solved: true, source: "policy", simulations: 1, elapsed: Duration::from_millis(3), policy_success: None })
    }
}
