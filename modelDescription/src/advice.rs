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
linearized along the step's own sub-steps, and agree with differences of repeated steps to 1&nbsp;%. They cost about three of these steps for each
direction, and nothing while nobody asks. Directly after a start or after <code>fmi2SetFMUstate</code> there is no last step, and asking is an error.
The dependencies in <code>ModelStructure</code> are empty all the same: at the communication point itself no output depends on an input.</p>
";

/// Which form of the ship's motion to give, with the figures of `cargo xtask report --only inputs`.
pub const ADVICE: &str = "";
