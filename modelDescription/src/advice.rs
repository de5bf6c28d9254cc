//! What the documentation says of derivatives: those that the FMU gives, and which inputs to give it.

/// What the FMU tells of its outputs.
pub const DERIVATIVES: &str = "<h2 id=\"derivatives\">Derivatives</h2>
<p><b>Of inputs</b> (<code>fmi2SetRealInputDerivatives</code>): orders 1 and 2, at the begin of the next step and for that step only; they beat the
velocity and acceleration inputs. Set-point, pose and their rates use both orders, current and body force the first.</p>
<p><b>Of outputs by time</b> (<code>fmi2GetRealOutputDerivatives</code>): order 1, for every Real output that is not marked &ldquo;no derivatives&rdquo;
below; asking for another one is an error that names it. They follow from the equations of motion at the communication point, on arrival: before new
inputs bring new accelerations. Positions and angles have their velocities; the derivative of a velocity output is the acceleration. Tensions are
balances of forces with inertia, and so their derivatives contain the cable's own fast waves: beside a slow motion they scatter by about the solver's
tolerance times the waves' frequency.</p>
<p><b>Of outputs by inputs</b> (<code>fmi2GetDirectionalDerivative</code>): how the outputs at the end of the last step change with the inputs that the
step began with, all else being the same: what Newton's method needs that looks for the inputs of a step. They come from the equations of motion
linearized along the step's own sub-steps, and agree with differences of repeated steps to 1&nbsp;%; to 5&nbsp;% for a jump of the pose. They are
those of the step as it was computed: with a loose <code>solver.tolerance</code> a difference over large changes, whose sub-steps differ, is another one. Where a cable
sticks on a sheave with friction, and for lateral reactions of a stiff drum, neither they nor differences are to be trusted. They cost about three of these steps for each
direction, and nothing while nobody asks. Directly after a start or after <code>fmi2SetFMUstate</code> there is no last step, and asking is an error.
The dependencies in <code>ModelStructure</code> are empty all the same: at the communication point itself no output depends on an input.</p>
";

/// Which form of the ship's motion to give, with the figures of `cargo xtask report --only inputs`.
pub const ADVICE: &str = "<p><b>Which inputs for the ship's motion.</b> Greatest error of <code>winch.tension</code> over its mean, for 400 kg on 150 m
of wire over the stern of an 80 m ship in seas of 2.5 m, whose motions have periods of 7 to 11 s:</p>
<table>
<tr><th>Communication step</th><th>pose</th><th>pose_velocity</th><th>pose_velocity_acceleration</th></tr>
<tr><td>10 ms</td><td>0.024 %</td><td>0.002 %</td><td>0.002 %</td></tr>
<tr><td>20 ms</td><td>0.037 %</td><td>0.004 %</td><td>0.003 %</td></tr>
<tr><td>50 ms</td><td>0.40 %</td><td>0.16 %</td><td>0.045 %</td></tr>
<tr><td>100 ms</td><td>3.0 %</td><td>1.7 %</td><td>0.72 %</td></tr>
<tr><td>200 ms</td><td>17 %</td><td>18 %</td><td>11 %</td></tr>
</table>
<p>So: at steps up to 20 ms a pose alone will do; up to 50 ms give velocities, up to 100 ms accelerations too; above, make smaller steps. Input
derivatives of order 1 and 2 are as good as the inputs for velocity and acceleration: they give the same motion. No form holds the pose still
within a step: the FMU continues the highest derivative that it has by the parabola through its last three values.</p>
";

/// The built-in set-points; in the documentation of FMUs that have one.
pub const COMPENSATION: &str = "<h2 id=\"compensation\">Heave compensation</h2>
<p>The winch of this FMU has a built-in set-point (<code>winch.setpoint</code> in the scene file) instead of the inputs <code>winch.setpoint</code> and
<code>winch.setpoint_rate</code>. What the controller is told is the output <code>winch.target</code>, to be compared with <code>winch.angle</code>, or with
<code>winch.payout</code> where <code>command = \"payout\"</code>. With r<sub>s</sub> the point that the cable hangs from, u the unit vector down the cable
there, and index 0 for the start of the run, the length to be paid out since then is</p>
<table>
<tr><td>simplified_sheave</td><td>&minus;u<sub>0</sub>&middot;(r<sub>s</sub> &minus; r<sub>s0</sub>)</td></tr>
<tr><td>sheave</td><td>&minus;u&middot;(r<sub>s</sub> &minus; r<sub>s0</sub>), u the present direction</td></tr>
<tr><td>waterline</td><td>|r<sub>s</sub> &minus; r<sub>w</sub>| &minus; |r<sub>s0</sub> &minus; r<sub>w</sub>|, r<sub>w</sub> where the line from r<sub>s0</sub>
along u<sub>0</sub> meets the still water</td></tr>
</table>
<p>r<sub>s</sub> is a point of the ship: where the cable leaves the last sheave at the start, or the drum's top in a scene without sheaves. u is the cable's
direction where it is straight, three bending lengths &radic;(EI/T) and half a wheel's radius farther on. So initialize with the ship at its mean
pose and at rest: that is what these set-points take for the mean. The mean does not follow a ship that sails or drifts away; let the current flow past
it instead. The present direction passes a low-pass filter (critically damped, of corner 8&nbsp;&radic;(g/L), L the length that hangs), without which the winch
could feed the cable's own transverse waves; the ship's motion does not pass it. The set-point goes with its rate to the controller
&phi;&#776; = k<sub>1</sub>(&phi;<sub>SP</sub> &minus; &phi;) + k<sub>2</sub>(&phi;&#775;<sub>SP</sub> &minus; &phi;&#775;), which then lags by about
&omega;&sup2;/k<sub>1</sub> of a motion of angular frequency &omega;; give the ship's velocities for it. Along a line at an angle &theta; from the plumb line a slow heave z
leaves z sin&sup2;&theta; at the body even so.</p>
";
