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
