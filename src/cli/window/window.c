/* Implements the window of the command `view` with SDL 2. The SDL library is loaded when a window
 * is opened. All other commands therefore run where SDL is not installed, and start without the
 * fifty libraries that SDL needs. Only the types of SDL's functions are taken from SDL.h. */
#include "cli/window/window.h"

#include <SDL.h>
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#define SDL_FUNCTIONS(X)                                                                           \
    X(GetVersion)                                                                                  \
    X(SetMainReady)                                                                                \
    X(SetHint)                                                                                     \
    X(Init)                                                                                        \
    X(Quit)                                                                                        \
    X(GetError)                                                                                    \
    X(CreateWindow)                                                                                \
    X(DestroyWindow)                                                                               \
    X(SetWindowTitle)                                                                              \
    X(GetCurrentVideoDriver)                                                                       \
    X(GetWindowSurface)                                                                            \
    X(LockSurface)                                                                                 \
    X(UnlockSurface)                                                                               \
    X(UpdateWindowSurface)                                                                         \
    X(GetModState)                                                                                 \
    X(PollEvent)                                                                                   \
    X(Delay)

/* SDL's functions under their names without "SDL_". */
typedef struct Sdl {
#define X(name) __typeof__(&SDL_##name) name;
    SDL_FUNCTIONS(X)
#undef X
} Sdl;

struct Window {
    void *library;
    Sdl sdl;
    bool started;
    SDL_Window *window;
    const uint8_t *overlay; /* borrowed; NULL: none */
    int overlay_width, overlay_height;
};

static Status load(Window *window, Err *err)
{
    window->library = dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
    if (!window->library)
        return err_set(err, STATUS_TOOL,
                       "a window needs SDL 2 (Debian: libsdl2-2.0-0), which cannot be loaded: %s",
                       dlerror());
    const struct {
        const char *name;
        void *where;
    } functions[] = {
#define X(name) {"SDL_" #name, &window->sdl.name},
        SDL_FUNCTIONS(X)
#undef X
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        void *found = dlsym(window->library, functions[i].name);
        if (!found)
            return err_set(err, STATUS_TOOL, "SDL 2 is too old: it has no %s", functions[i].name);
        memcpy(functions[i].where, &found, sizeof found);
    }
    return STATUS_OK;
}

static Status failed(const Window *window, const char *what, Err *err)
{
    return err_set(err, STATUS_TOOL, "%s: %s", what, window->sdl.GetError());
}

/* Returns false for SDL's drivers without a visible display. SDL chooses such a driver if no
 * display responds. */
static bool is_seen(const char *driver)
{
    return strcmp(driver, "dummy") != 0 && strcmp(driver, "offscreen") != 0;
}

/* Initializes SDL and opens the window. The first hint keeps SDL from handling signals. The second
 * hint turns off 3D acceleration of the window, so that its pixels are in ordinary memory; its
 * reason is not recorded. A driver without a visible display is accepted only if the user selected
 * it by SDL_VIDEODRIVER. */
static Status start(Window *window, const char *title, int width, int height, Err *err)
{
    const Sdl *sdl = &window->sdl;
    sdl->SetMainReady();
    sdl->SetHint("SDL_NO_SIGNAL_HANDLERS", "1");
    sdl->SetHint("SDL_FRAMEBUFFER_ACCELERATION", "0");
    if (sdl->Init(SDL_INIT_VIDEO) != 0)
        return failed(window, "there is no display to open a window on", err);
    window->started = true;
    if (!is_seen(sdl->GetCurrentVideoDriver()) && !getenv("SDL_VIDEODRIVER"))
        return err_set(err, STATUS_TOOL,
                       "there is no display to open a window on: the display that DISPLAY names "
                       "does not respond");
    window->window =
        sdl->CreateWindow(title, (int)SDL_WINDOWPOS_UNDEFINED, (int)SDL_WINDOWPOS_UNDEFINED, width,
                          height, SDL_WINDOW_RESIZABLE);
    return window->window ? STATUS_OK : failed(window, "the window cannot be opened", err);
}

Status window_open(Window **out, const char *title, int width, int height, Err *err)
{
    Window *window;
    TRY(mem_calloc(&window, 1, sizeof *window, "windows", err));
    Status status = STATUS_OK;
    if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY") && !getenv("SDL_VIDEODRIVER"))
        status = err_set(err, STATUS_TOOL,
                         "there is no display to open a window on: neither DISPLAY nor "
                         "WAYLAND_DISPLAY is set");
    if (status == STATUS_OK)
        status = load(window, err);
    if (status == STATUS_OK)
        status = start(window, title, width, height, err);
    if (status != STATUS_OK) {
        window_close(window);
        return status;
    }
    *out = window;
    return STATUS_OK;
}

/* SDL stays loaded, because some of the libraries that SDL loads do not tolerate being unloaded. */
void window_close(Window *window)
{
    if (!window)
        return;
    if (window->window)
        window->sdl.DestroyWindow(window->window);
    if (window->started)
        window->sdl.Quit();
    free(window);
}

/* The left button with Shift acts as the middle button. */
static WindowEvent drag_event(const Window *window, const SDL_MouseMotionEvent *motion)
{
    WindowEvent event = {.kind = WINDOW_DRAG, .x = motion->xrel, .y = motion->yrel};
    if (motion->state & SDL_BUTTON_LMASK)
        event.button = window->sdl.GetModState() & KMOD_SHIFT ? WINDOW_MIDDLE : WINDOW_LEFT;
    else if (motion->state & SDL_BUTTON_MMASK)
        event.button = WINDOW_MIDDLE;
    else if (motion->state & SDL_BUTTON_RMASK)
        event.button = WINDOW_RIGHT;
    else
        event.kind = WINDOW_NOTHING;
    return event;
}

/* Returns the event that an event of SDL stands for; WINDOW_NOTHING for all others. */
static WindowEvent translate(const Window *window, const SDL_Event *from)
{
    switch (from->type) {
    case SDL_QUIT:
        return (WindowEvent){.kind = WINDOW_QUIT};
    case SDL_KEYDOWN:
        return (WindowEvent){.kind = WINDOW_KEY, .key = (int)from->key.keysym.sym};
    case SDL_MOUSEMOTION:
        return drag_event(window, &from->motion);
    case SDL_MOUSEWHEEL:
        return (WindowEvent){.kind = WINDOW_WHEEL, .y = from->wheel.y};
    case SDL_WINDOWEVENT:
        if (from->window.event == SDL_WINDOWEVENT_SIZE_CHANGED)
            return (WindowEvent){
                .kind = WINDOW_SIZE, .x = from->window.data1, .y = from->window.data2};
        if (from->window.event == SDL_WINDOWEVENT_EXPOSED)
            return (WindowEvent){.kind = WINDOW_EXPOSED};
        break;
    default:
        break;
    }
    return (WindowEvent){.kind = WINDOW_NOTHING};
}

/* Skips events of no WindowEventKind. Waits by polling every PAUSE_MS. SDL_WaitEvent is not used:
 * in SDL 2.26 it sends messages to the window over a second connection to X. If the window has been
 * closed in the meantime, X answers with an error, and the error ends the program. */
WindowEvent window_event(Window *window, bool wait)
{
    enum { PAUSE_MS = 5 }; /* shorter than a picture takes; larger: fewer polls, later answers */
    for (;;) {
        SDL_Event next;
        while (window->sdl.PollEvent(&next)) {
            WindowEvent event = translate(window, &next);
            if (event.kind != WINDOW_NOTHING)
                return event;
        }
        if (!wait)
            return (WindowEvent){.kind = WINDOW_NOTHING};
        window->sdl.Delay(PAUSE_MS);
    }
}

/* Copies a row of n pixels to a row of the window that has the same width and pixels of the format
 * 0xRRGGBB. Nearly all windows have this format. */
static void copy_row(const uint8_t *rgb, int n, uint32_t alpha, uint32_t *pixels)
{
    for (int x = 0; x < n; x++, rgb += 3)
        pixels[x] = alpha | (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
}

/* Scales a row of `width` pixels to n pixels by nearest-neighbour sampling, and converts it to the
 * window's pixel format. */
static void stretch_row(const uint8_t *rgb, int width, const SDL_PixelFormat *format, int n,
                        uint32_t *pixels)
{
    uint64_t step = ((uint64_t)width << 32) / (uint64_t)n, at = 0; /* in 1 / 2^32 of a pixel */
    for (int x = 0; x < n; x++, at += step) {
        const uint8_t *from = rgb + 3 * (at >> 32);
        pixels[x] = (uint32_t)from[0] << format->Rshift | (uint32_t)from[1] << format->Gshift |
                    (uint32_t)from[2] << format->Bshift | format->Amask;
    }
}

/* Scales the picture to the size of the window, whose pixels have 32 bits each. */
static void stretch(const uint8_t *rgb, int width, int height, SDL_Surface *to)
{
    const SDL_PixelFormat *format = to->format;
    const bool as_is =
        width == to->w && format->Rshift == 16 && format->Gshift == 8 && format->Bshift == 0;
    for (int y = 0; y < to->h; y++) {
        uint32_t *pixels = (uint32_t *)((uint8_t *)to->pixels + (size_t)y * (size_t)to->pitch);
        const uint8_t *row = rgb + (size_t)((long long)y * height / to->h) * (size_t)width * 3;
        if (as_is)
            copy_row(row, width, format->Amask, pixels);
        else
            stretch_row(row, width, format, to->w, pixels);
    }
}

/* Blends a row of n RGBA pixels, whose colors are multiplied by alpha, over a row of the window. */
static void blend_row(const uint8_t *rgba, const SDL_PixelFormat *format, int n, uint32_t *pixels)
{
    const uint8_t shifts[] = {format->Rshift, format->Gshift, format->Bshift};
    for (int x = 0; x < n; x++, rgba += 4) {
        if (rgba[3] == 0)
            continue;
        uint32_t made = format->Amask;
        for (int c = 0; c < 3; c++) {
            const uint32_t below = pixels[x] >> shifts[c] & 255;
            made |= (rgba[c] + below * (255u - rgba[3]) / 255) << shifts[c];
        }
        pixels[x] = made;
    }
}

/* Blends the overlay over the window, unless it was drawn for another size of the window. */
static void blend(const Window *window, SDL_Surface *to)
{
    if (!window->overlay || window->overlay_width != to->w || window->overlay_height != to->h)
        return;
    for (int y = 0; y < to->h; y++)
        blend_row(window->overlay + (size_t)y * (size_t)to->w * 4, to->format, to->w,
                  (uint32_t *)((uint8_t *)to->pixels + (size_t)y * (size_t)to->pitch));
}

void window_overlay(Window *window, const uint8_t *rgba, int width, int height)
{
    window->overlay = rgba;
    window->overlay_width = width;
    window->overlay_height = height;
}

Status window_show(Window *window, const uint8_t *rgb, int width, int height, Err *err)
{
    const Sdl *sdl = &window->sdl;
    SDL_Surface *surface = sdl->GetWindowSurface(window->window);
    if (!surface || surface->format->BytesPerPixel != 4 || sdl->LockSurface(surface) != 0)
        return failed(window, "the window cannot be drawn to", err);
    stretch(rgb, width, height, surface);
    blend(window, surface);
    sdl->UnlockSurface(surface);
    return sdl->UpdateWindowSurface(window->window) == 0
               ? STATUS_OK
               : failed(window, "the window cannot be drawn to", err);
}

void window_title(Window *window, const char *title)
{
    window->sdl.SetWindowTitle(window->window, title);
}

/* Unloads SDL again. SDL was not initialized, so it has loaded nothing that window_close must leave
 * loaded. */
void window_put_library(Text *text)
{
    Window window = {0};
    Err err = {{0}};
    SDL_version version;
    if (load(&window, &err) == STATUS_OK) {
        window.sdl.GetVersion(&version);
        text_printf(text, "%d.%d.%d", version.major, version.minor, version.patch);
    } else {
        text_put_line(text, err.text);
    }
    if (window.library)
        dlclose(window.library);
}
