    state->seen = 1;
    return @name@_recurrent(state->hidden, features);
