/* Odd over even polynomial: within 4e-7 of the tangent in single precision. The argument is
   clamped to 7.9 by its bits, nan kept: comparing floats would stop compilers from vectorising. */
static inline float @name@_tanh(float x)
{
    union {
        float value;
        uint32_t bits;
    } given, size;
    float y, p, q;
    given.value = x;
    size.bits = given.bits & 0x7fffffffu;
    size.bits = (size.bits > 0x40fccccdu) & (size.bits <= 0x7f800000u) ? 0x40fccccdu : size.bits;
    size.bits |= given.bits & 0x80000000u;
    x = size.value;
    y = x * x;
    p = 1.525970469056e-08f;
    p = p * y + 2.190343166127e-05f;
    p = p * y + 3.571696820808e-03f;
    p = p * y + 1.344445238474e-01f;
    p = p * y + 9.999999735524e-01f;
    q = 8.530556767722e-07f;
    q = q * y + 3.411743444418e-04f;
    q = q * y + 2.616441584427e-02f;
    q = q * y + 4.677777456271e-01f;
    q = q * y + 1.0f;
    return x * p / q;
}

/* sums (columns) += values (rows) times weights (rows, columns), four rows at a time. */
static inline void @name@_add(const float *restrict weights, const float *restrict values,
                              int rows, int columns, float *restrict sums)
{
    const int whole = rows - rows % 4;
    int i, j;
    for (i = 0; i < whole; i += 4) {
        const float *restrict w = weights + i * columns;
        const float a = values[i], b = values[i + 1], c = values[i + 2], d = values[i + 3];
        for (j = 0; j < columns; j++)
            sums[j] = sums[j] + w[j] * a + w[columns + j] * b + w[2 * columns + j] * c
                      + w[3 * columns + j] * d;
    }
    for (i = whole; i < rows; i++) {
        const float *restrict w = weights + i * columns;
        const float a = values[i];
        for (j = 0; j < columns; j++)
            sums[j] += w[j] * a;
    }
}

/* The head's sum, in eight parts that run side by side. */
static inline float @name@_last(const float *values)
{
    float part[8] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    float torque = @OFFSET@;
    const int whole = @NAME@_HIDDEN - @NAME@_HIDDEN % 8;
    int i, j;
    for (i = 0; i < whole; i += 8)
        for (j = 0; j < 8; j++)
            part[j] += @name@_head[i + j] * values[i + j];
    for (i = whole; i < @NAME@_HIDDEN; i++)
        torque += @name@_head[i] * values[i];
    for (j = 0; j < 8; j++)
        torque += part[j];
    return torque;
}
