// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/portaudio.hpp"

#include "devices/audio/portaudio_session.hpp"
#include "devices/audio/quiet.hpp"
#include "devices/audio/stream_state.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <portaudio.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace tactus {
namespace {

/// The default of JACK when it runs, since it then owns the card, otherwise the system's.
PaDeviceIndex default_output() {
    const PaHostApiIndex jack = Pa_HostApiTypeIdToHostApiIndex(paJACK);
    if (jack >= 0 && Pa_GetHostApiInfo(jack)->defaultOutputDevice != paNoDevice)
        return Pa_GetHostApiInfo(jack)->defaultOutputDevice;
    return Pa_GetDefaultOutputDevice();
}

PaDeviceIndex find_output(const std::string& wanted) {
    std::string names;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(i);
        if (info.maxOutputChannels == 0) continue;
        const std::string name = audio_device_name(i);
        if (!wanted.empty() && name.find(wanted) != std::string::npos) return i;
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name);
    }
    if (names.empty()) throw Error("there is no sound output on this machine");
    if (!wanted.empty()) throw Error(fmt::format("there is no sound output '{}'; there are: {}", wanted, names));
    const PaDeviceIndex index = default_output();
    if (index == paNoDevice) throw Error(fmt::format("no sound output is the default; choose one of: {}", names));
    return index;
}

int feed_card(const void*, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*, PaStreamCallbackFlags,
              void* state) {
    const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
    static_cast<StreamState*>(state)->feed(static_cast<float*>(output), frames, now.count());
    return paContinue;
}

class PortAudioSink final : public AudioSink {
public:
    PortAudioSink(std::string device, double buffer_s) : device_(std::move(device)), buffer_s_(buffer_s) {}
    ~PortAudioSink() override { release(); }

    const std::string& name() const override { return name_; }

    void prepare(double rate, int channels) override {
        release();
        session_ = std::make_unique<PortAudioSession>();
        try {
            open(rate, channels);
        } catch (...) {
            release();
            throw;
        }
    }

    std::size_t write(const float* interleaved, std::size_t frames) noexcept override {
        return state_ ? state_->write(interleaved, frames) : 0;
    }
    std::size_t writable() const noexcept override { return state_ ? state_->writable() : 0; }
    AudioStatistics statistics() const noexcept override { return state_ ? state_->statistics() : AudioStatistics{}; }
    AudioProgress progress() const noexcept override { return state_ ? state_->progress() : AudioProgress{}; }
    void close() override { release(); }

private:
    void open(double rate, int channels) {
        const QuietStderr quiet;
        PaStreamParameters parameters{};
        parameters.device = find_output(device_);
        const PaDeviceInfo& info = *Pa_GetDeviceInfo(parameters.device);
        name_ = audio_device_name(parameters.device);
        if (channels < 1 || channels > info.maxOutputChannels)
            throw Error(fmt::format("'{}' has {} channels, {} are needed", name_, info.maxOutputChannels, channels));
        parameters.channelCount = channels;
        parameters.sampleFormat = paFloat32;
        parameters.suggestedLatency = info.defaultLowOutputLatency;
        state_ = std::make_unique<StreamState>(channels, static_cast<std::size_t>(std::ceil(buffer_s_ * rate)));
        PaError error = Pa_OpenStream(&stream_, nullptr, &parameters, rate, paFramesPerBufferUnspecified, paNoFlag,
                                      feed_card, state_.get());
        if (error == paNoError) error = Pa_StartStream(stream_);
        if (error == paNoError) return;
        if (stream_ != nullptr) Pa_CloseStream(stream_);
        stream_ = nullptr;
        throw Error(
            fmt::format("'{}' cannot play {} channels at {} Hz: {}", name_, channels, rate, Pa_GetErrorText(error)));
    }

    /// True when the card still asks for sound. Stopping a stream whose server died would block for ever.
    bool is_alive() const {
        if (Pa_IsStreamActive(stream_) != 1) return false;
        const std::int64_t before = state_->progress().frames;
        for (int i = 0; i < 50; ++i) {
            if (state_->progress().frames != before) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    void release() {
        if (stream_ != nullptr && !is_alive()) {
            // A dead stream may still hold our pointers: it is left, with all it uses, to the end of the process.
            static_cast<void>(state_.release());
            static_cast<void>(session_.release());
            stream_ = nullptr;
            return;
        }
        if (stream_ != nullptr) {
            const QuietStderr quiet;
            Pa_StopStream(stream_);
            Pa_CloseStream(stream_);
            stream_ = nullptr;
        }
        state_.reset();
        session_.reset();
    }

    std::string device_, name_ = "sound card";
    double buffer_s_;
    std::unique_ptr<PortAudioSession> session_;
    std::unique_ptr<StreamState> state_;
    PaStream* stream_ = nullptr;
};

}  // namespace

std::vector<AudioOutput> list_audio_outputs() {
    const PortAudioSession session;
    std::vector<AudioOutput> outputs;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i)
        if (const PaDeviceInfo& info = *Pa_GetDeviceInfo(i); info.maxOutputChannels > 0)
            outputs.push_back({audio_device_name(i), info.maxOutputChannels, info.defaultSampleRate});
    return outputs;
}

std::unique_ptr<AudioSink> make_portaudio_sink(std::string device, double buffer_s) {
    return std::make_unique<PortAudioSink>(std::move(device), buffer_s);
}

}  // namespace tactus
