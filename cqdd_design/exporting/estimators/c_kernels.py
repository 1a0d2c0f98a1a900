"""The C of the header: text with the network's name for ``@name@`` and ``@NAME@``."""

COMMON = """\
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
"""

GRU = """\
/* One layer, one step: hidden (HIDDEN) from values (rows) and itself. */
static inline void @name@_layer(const float *restrict input, const float *restrict across,
                                const float *restrict bias, const float *restrict values,
                                int rows, float *restrict hidden)
{
    enum { H = @NAME@_HIDDEN };
    float sums[4 * H]; /* new from the input, reset, update, new from the state */
    int j;
    for (j = 0; j < 4 * H; j++)
        sums[j] = bias[j];
    @name@_add(input, values, rows, 3 * H, sums);
    @name@_add(across, hidden, H, 3 * H, sums + H);
    for (j = H; j < 3 * H; j++)
        sums[j] = 0.5f + 0.5f * @name@_tanh(sums[j]);
    for (j = 0; j < H; j++) {
        const float fresh = @name@_tanh(sums[j] + sums[H + j] * sums[3 * H + j]);
        hidden[j] = fresh + sums[2 * H + j] * (hidden[j] - fresh);
    }
}

/* Torque (N m) of one sample of raw features; hidden (LAYERS, HIDDEN) goes on to the next. */
static inline float @name@_recurrent(float *hidden, const float *features)
{
    const float *newest = features;
    (void)newest;
@STEP@
    return @name@_last(hidden + (@NAME@_LAYERS - 1) * @NAME@_HIDDEN)@CORRECTION@;
}

/* One layer over a window from a zero state; `values` may be `samples`. */
static inline void @name@_sequence(const float *restrict input, const float *restrict across,
                                   const float *restrict bias, const float *samples, int rows,
                                   float *values)
{
    enum { H = @NAME@_HIDDEN };
    float hidden[H];
    int i, j;
    for (j = 0; j < H; j++)
        hidden[j] = 0.0f;
    for (i = 0; i < @NAME@_HISTORY; i++) {
        @name@_layer(input, across, bias, samples + i * rows, rows, hidden);
        for (j = 0; j < H; j++)
            values[i * H + j] = hidden[j];
    }
}

/* Torque (N m) at the end of a window of raw features (HISTORY, FEATURES), oldest first. */
static inline float @name@_window(const float *samples)
{
    const float *newest = samples + (@NAME@_HISTORY - 1) * @NAME@_FEATURES;
    float values[@NAME@_HISTORY * @NAME@_HIDDEN];
    (void)newest;
@WINDOW@
    return @name@_last(values + (@NAME@_HISTORY - 1) * @NAME@_HIDDEN)@CORRECTION@;
}

/* Many windows at once, one in each lane: for throughput on a computer. */
enum {
    @NAME@_LANES = 64,
    @NAME@_WIDEST = @NAME@_FEATURES > @NAME@_HIDDEN ? @NAME@_FEATURES : @NAME@_HIDDEN
};

/* In every lane a, b, c += values (rows) times three columns of weights (rows, 3 HIDDEN). */
static inline void @name@_lane_add(const float *restrict weights,
                                   float (*restrict values)[@NAME@_LANES], int rows,
                                   float *restrict a, float *restrict b, float *restrict c)
{
    enum { H = @NAME@_HIDDEN, W = 3 * H };
    const int whole = rows - rows % 4;
    int i, s;
    for (i = 0; i < whole; i += 4) {
        const float *restrict w = weights + i * W;
        const float a0 = w[0], a1 = w[W], a2 = w[2 * W], a3 = w[3 * W];
        const float b0 = w[H], b1 = w[W + H], b2 = w[2 * W + H], b3 = w[3 * W + H];
        const float c0 = w[2 * H], c1 = w[W + 2 * H], c2 = w[2 * W + 2 * H],
                    c3 = w[3 * W + 2 * H];
        for (s = 0; s < @NAME@_LANES; s++) {
            const float u = values[i][s], v = values[i + 1][s], x = values[i + 2][s],
                        y = values[i + 3][s];
            a[s] = a[s] + a0 * u + a1 * v + a2 * x + a3 * y;
            b[s] = b[s] + b0 * u + b1 * v + b2 * x + b3 * y;
            c[s] = c[s] + c0 * u + c1 * v + c2 * x + c3 * y;
        }
    }
    for (i = whole; i < rows; i++) {
        const float a0 = weights[i * W], b0 = weights[i * W + H], c0 = weights[i * W + 2 * H];
        for (s = 0; s < @NAME@_LANES; s++) {
            const float u = values[i][s];
            a[s] += a0 * u;
            b[s] += b0 * u;
            c[s] += c0 * u;
        }
    }
}

/* One layer over the windows of all lanes, in place. */
static inline void @name@_lane_layer(const float *restrict input, const float *restrict across,
                                     const float *restrict bias, int rows,
                                     float (*values)[@NAME@_WIDEST][@NAME@_LANES])
{
    enum { H = @NAME@_HIDDEN, S = @NAME@_LANES };
    float hidden[H][S], next[H][S], n[S], r[S], z[S], m[S];
    int i, j, s;
    for (j = 0; j < H; j++)
        for (s = 0; s < S; s++)
            hidden[j][s] = 0.0f;
    for (i = 0; i < @NAME@_HISTORY; i++) {
        for (j = 0; j < H; j++) {
            for (s = 0; s < S; s++) {
                n[s] = bias[j];
                r[s] = bias[H + j];
                z[s] = bias[2 * H + j];
                m[s] = bias[3 * H + j];
            }
            @name@_lane_add(input + j, values[i], rows, n, r, z);
            @name@_lane_add(across + j, hidden, H, r, z, m);
            for (s = 0; s < S; s++) {
                const float reset = 0.5f + 0.5f * @name@_tanh(r[s]);
                const float update = 0.5f + 0.5f * @name@_tanh(z[s]);
                const float fresh = @name@_tanh(n[s] + reset * m[s]);
                next[j][s] = fresh + update * (hidden[j][s] - fresh);
            }
        }
        for (j = 0; j < H; j++)
            for (s = 0; s < S; s++)
                values[i][j][s] = hidden[j][s] = next[j][s];
    }
}

/* Torque (count) at the end of windows of raw features (count, HISTORY, FEATURES). */
static inline void @name@_windows(const float *samples, long count, float *torque)
{
    enum { F = @NAME@_FEATURES, T = @NAME@_HISTORY };
    float values[T][@NAME@_WIDEST][@NAME@_LANES];
    long first;
    int i, j, s;
    for (first = 0; first < count; first += @NAME@_LANES) {
        const long left = count - first;
        const int lanes = left < @NAME@_LANES ? (int)left : @NAME@_LANES;
        for (i = 0; i < T; i++)
            for (j = 0; j < F; j++)
                for (s = 0; s < @NAME@_LANES; s++)
                    values[i][j][s] = s < lanes ? samples[((first + s) * T + i) * F + j] : 0.0f;
@LANE_LAYERS@
        for (s = 0; s < lanes; s++) {
            const float *newest = samples + ((first + s) * T + T - 1) * F;
            float last[@NAME@_HIDDEN];
            (void)newest;
            for (j = 0; j < @NAME@_HIDDEN; j++)
                last[j] = values[T - 1][j][s];
            torque[first + s] = @name@_last(last)@CORRECTION@;
        }
    }
}
"""

ACTIVATIONS = {
    "relu": "return x > 0.0f ? x : 0.0f;",
    "tanh": "return @name@_tanh(x);",
    "softsign": "return x / (1.0f + (x < 0.0f ? -x : x));",
    "elu": """\
/* exp(x) - 1 by the tangent of half of it, without loss near zero */
    const float t = @name@_tanh(0.5f * (x < -15.0f ? -15.0f : x));
    return x > 0.0f ? x : 2.0f * t / (1.0f - t);""",
}

MLP = """\
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
"""

ENTRY = """\
/* What is kept from sample to sample. */
typedef struct {
    float @KEPT@[@KEPT_SIZE@];
    float velocity[@NAME@_TAPS]; /* newest first, for the acceleration */
    int moved, seen;
} @name@_state;

/* Forget all samples. */
static inline void @name@_reset(@name@_state *state)
{
    int i;
    for (i = 0; i < @KEPT_SIZE@; i++)
        state->@KEPT@[i] = 0.0f;
    for (i = 0; i < @NAME@_TAPS; i++)
        state->velocity[i] = 0.0f;
    state->moved = state->seen = 0;
}

static inline void @name@_init(@name@_state *state)
{
    @name@_reset(state);
}

/* Whether there are samples enough for an estimate. */
static inline int @name@_ready(const @name@_state *state)
{
    return state->seen >= @NEEDED@;
}

/* Torque (N m) at this sample. */
static inline float @name@_step(@name@_state *state, @ARGUMENTS@)
{
@DECLARED@
@BODY@
}
"""

RUN_STREAMING = """\
    state->seen = 1;
    return @name@_recurrent(state->hidden, features);"""

RUN_WINDOW = """\
    for (i = 0; i < (@NAME@_HISTORY - 1) * @NAME@_FEATURES; i++)
        state->past[i] = state->past[i + @NAME@_FEATURES];
    for (i = 0; i < @NAME@_FEATURES; i++)
        state->past[(@NAME@_HISTORY - 1) * @NAME@_FEATURES + i] = features[i];
    state->seen += state->seen < @NAME@_HISTORY;
    return @name@_ready(state) ? @name@_window(state->past) : 0.0f;"""
