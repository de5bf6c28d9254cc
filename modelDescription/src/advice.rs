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
