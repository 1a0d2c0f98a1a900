/* What the gearbox's errors add to a torque of the motor (N m at the joint), between two of
   @POINTS@ places in a turn. Sine and cosine of each order follow from those of the one before. */
static inline double @name@_ripple(double position, double torque)
{
    const double step = @STEP_ANGLE@;
    const double place = floor(@WAY@ * position / step);
    const double after = @WAY@ * position / step - place;
    const double part[2] = {1.0 - after, after};
    double slope = 0.0, share = 1.0, share_slope = 0.0, size, windup, energy;
    double c[2] = {1.0, 1.0}, s[2] = {0.0, 0.0}, first_c[2], first_s[2];
    int i, j, order = 0;
    for (j = 0; j < 2; j++) {
        const double angle = step * fmod(place + j, @POINTS@.0);
        first_c[j] = cos(angle);
        first_s[j] = sin(angle);
    }
    for (i = 0; i < @NAME@_ORDERS; i++) {
        double here_c, here_s;
        for (; order < @name@_order[i]; order++)
            for (j = 0; j < 2; j++) {
                const double turned = c[j] * first_c[j] - s[j] * first_s[j];
                s[j] = s[j] * first_c[j] + c[j] * first_s[j];
                c[j] = turned;
            }
        here_c = part[0] * c[0] + part[1] * c[1];
        here_s = part[0] * s[0] + part[1] * s[1];
        slope += order * (@name@_error_sine[i] * here_c - @name@_error_cosine[i] * here_s);
        share += @name@_share_cosine[i] * here_c + @name@_share_sine[i] * here_s;
        share_slope += order * (@name@_share_sine[i] * here_c - @name@_share_cosine[i] * here_s);
    }
    size = torque < 0.0 ? -torque : torque;
    windup = @WINDUP@ * pow(size / (share * @ERROR_TORQUE@), @SOFTENING@);
    energy = size * windup / (@STIFFENING_MORE@ * share);
    return (torque - @WAY@ * energy * share_slope) / (1.0 + @WAY@ * slope) - torque;
}
