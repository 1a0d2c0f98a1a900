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
