static inline float @name@_activation(float x)
{
    @ACTIVATION@
}

/* One layer: found (HIDDEN) from values (rows). */
static inline void @name@_dense(const float *restrict weights, const float *restrict bias,
                                const float *restrict values, int rows, float *restrict found)
{
    int j;
    for (j = 0; j < @NAME@_HIDDEN; j++)
        found[j] = bias[j];
    @name@_add(weights, values, rows, @NAME@_HIDDEN, found);
    for (j = 0; j < @NAME@_HIDDEN; j++)
        found[j] = @name@_activation(found[j]);
}

/* Torque (N m) at the end of a window of raw features (HISTORY, FEATURES), oldest first. */
static inline float @name@_window(const float *samples)
{
    const float *newest = samples + (@NAME@_HISTORY - 1) * @NAME@_FEATURES;
    float flat[@NAME@_HISTORY * @NAME@_FEATURES];
    float even[@NAME@_HIDDEN], odd[@NAME@_HIDDEN];
    int i, j;
    (void)odd;
    for (i = 0; i < @NAME@_HISTORY; i++)
        for (j = 0; j < @NAME@_FEATURES; j++)
            flat[i * @NAME@_FEATURES + j] = newest[j - i * @NAME@_FEATURES];
@DENSE@
    return @name@_last(@LAST@)@CORRECTION@;
}

/* Torque (count) at the end of windows of raw features (count, HISTORY, FEATURES). */
static inline void @name@_windows(const float *samples, long count, float *torque)
{
    long i;
    for (i = 0; i < count; i++)
        torque[i] = @name@_window(samples + i * @NAME@_HISTORY * @NAME@_FEATURES);
}
