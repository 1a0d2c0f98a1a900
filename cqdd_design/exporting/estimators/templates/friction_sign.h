/* Smooth sign of dry friction, -1 to 1. */
static inline double @name@_friction_sign(double velocity)
{
    return tanh(@SIGN_RATE@ * velocity);
}
