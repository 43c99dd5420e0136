/* Both tables are made of the one list of rows. */
#include "scene/models.h"

const Model models[SCENE_MODELS] = {
#define X(symbol, called, said, made_of, held)                                                     \
    [SCENE_##symbol] = {                                                                           \
        .name = called, .description = said, .elements = made_of, .proof = PROOF_##held},
    MODEL_TABLE(X)
#undef X
};

const char *const model_names[] = {
#define X(symbol, called, said, made_of, held) called,
    MODEL_TABLE(X)
#undef X
        NULL};

/* The elements of a model that must be there, or that alone may be. */
static void list_models(unsigned any, unsigned alone, Text *out)
{
    bool listed[SCENE_MODELS];
    int n = 0;
    for (int i = 0; i < SCENE_MODELS; i++) {
        listed[i] = model_has((SceneModel)i, any) && model_is_of((SceneModel)i, alone);
        n += listed[i];
    }
    for (int i = 0, at = 0; i < SCENE_MODELS; i++) {
        if (!listed[i])
            continue;
        text_puts(out, at == 0 ? "" : at + 1 == n ? " and " : ", ");
        text_puts(out, models[i].name);
        at++;
    }
}

void models_with(unsigned elements, Text *out)
{
    list_models(elements, ~0U, out);
}

void models_of(unsigned elements, Text *out)
{
    list_models(~0U, elements, out);
}
