/* Torque of the drive (N m at the joint): impedance law within supply voltage and current limit. */
static inline double @name@_driven(double position_error, double velocity)
{
    const double back = @BACK@ * velocity;
    const double least = (-@SUPPLY@ - back) / @RESISTANCE@;
    const double most = (@SUPPLY@ - back) / @RESISTANCE@;
    double current = (@STIFFNESS_GAIN@ * position_error - @DAMPING_GAIN@ * velocity) / @BACK@;
    current = current < least ? least : current > most ? most : current;
    current = current < -@LIMIT@ ? -@LIMIT@ : current > @LIMIT@ ? @LIMIT@ : current;
    return @BACK@ * current;
}

/* What inertia and viscous drag leave of it (N m): the output torque but for dry friction. */
static inline double @name@_balance(double position_error, double velocity, double acceleration)
{
    return @name@_driven(position_error, velocity) - @INERTIA@ * acceleration
           - @DRAG@ * velocity;
}
