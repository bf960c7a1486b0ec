// SPDX-License-Identifier: Apache-2.0
// libtactus for C#: tactus.h by P/Invoke, for Unity, Godot and .NET. Copy this file into the project, and libtactus.so beside the
// program (Unity: Assets/Plugins/x86_64). Units are SI: m, rad, s, N, N·m. A patch or a run is used by one thread at a time.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Tactus
{
    /// <summary>Whole sentences with the place; of several errors one per line.</summary>
    public sealed class TactusException : Exception
    {
        public readonly string File;
        public readonly int Line, Column;

        internal TactusException(string text, string file, int line, int column) : base(text)
        {
            File = file;
            Line = line;
            Column = column;
        }
    }

    /// <summary>Where a hand is: m, quaternion (w, x, y, z), m/s, rad/s, in the frame of the device.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Motion
    {
        public double X, Y, Z;
        public double W, I, J, K;
        public double VelocityX, VelocityY, VelocityZ;
        public double TurningX, TurningY, TurningZ;
        public uint Buttons;
        public int Invalid;
    }

    /// <summary>Limits of the device that the program moves; 0: none or unknown.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Device
    {
        public double MaxForce, MaxTorque, Damping, Delay;
    }

    /// <summary>Force (N) and torque (N·m) on a hand.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Wrench
    {
        public double ForceX, ForceY, ForceZ, TorqueX, TorqueY, TorqueZ;
    }

    internal static class Native
    {
        private const string Library = "tactus";

        [StructLayout(LayoutKind.Sequential)]
        internal sealed class Error
        {
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 2048)] public byte[] Text = new byte[2048];
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 512)] public byte[] File = new byte[512];
            public int Line, Column;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Options
        {
            public UIntPtr Size;
            public double Seconds;
            public ulong Seed;
            public IntPtr Folder, Audio;
            public int Live, Threads;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct OutputInfo
        {
            public IntPtr Type, Names;
            public int Columns;
            public double Rate;
        }

        [DllImport(Library)] internal static extern IntPtr tactus_version();
        [DllImport(Library)] internal static extern IntPtr tactus_load(byte[] name, [In, Out] Error error);
        [DllImport(Library)] internal static extern IntPtr tactus_parse(byte[] toml, byte[] folder, [In, Out] Error error);
        [DllImport(Library)] internal static extern int tactus_configure(IntPtr patch, byte[] setting, [In, Out] Error error);
        [DllImport(Library)] internal static extern int tactus_use_asset(IntPtr patch, byte[] asset, [In, Out] Error error);
        [DllImport(Library)]
        internal static extern int tactus_attach_hand(IntPtr patch, byte[] name, ref Device device, [In, Out] Error error);
        [DllImport(Library)] internal static extern void tactus_free_patch(IntPtr patch);
        [DllImport(Library)] internal static extern IntPtr tactus_start(IntPtr patch, ref Options options, [In, Out] Error error);
        [DllImport(Library)] internal static extern int tactus_advance(IntPtr run, double seconds, [In, Out] Error error);
        [DllImport(Library)] internal static extern double tactus_time(IntPtr run);
        [DllImport(Library)] internal static extern int tactus_set(IntPtr run, byte[] name, byte[] value, [In, Out] Error error);
        [DllImport(Library)] internal static extern int tactus_find_hand(IntPtr run, byte[] name, [In, Out] Error error);
        [DllImport(Library)] internal static extern void tactus_move_hand(IntPtr run, int hand, ref Motion motion);
        [DllImport(Library)] internal static extern void tactus_hand_force(IntPtr run, int hand, out Wrench wrench);
        [DllImport(Library)]
        internal static extern int tactus_output(IntPtr run, byte[] port, int every, out OutputInfo info, [In, Out] Error error);
        [DllImport(Library)] internal static extern void tactus_newest(IntPtr run, int output, double[] values);
        [DllImport(Library)] internal static extern int tactus_finish(IntPtr run, [In, Out] Error error);
        [DllImport(Library)] internal static extern ulong tactus_hash(IntPtr run);
        [DllImport(Library)] internal static extern void tactus_free_run(IntPtr run);

        /// Text of C, in UTF-8 and with its 0.
        internal static byte[] Utf8(string text)
        {
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        internal static string TextOf(byte[] utf8)
        {
            int length = Array.IndexOf(utf8, (byte)0);
            return Encoding.UTF8.GetString(utf8, 0, length < 0 ? utf8.Length : length);
        }

        internal static void Check(bool failed, Error error)
        {
            if (failed) throw new TactusException(TextOf(error.Text), TextOf(error.File), error.Line, error.Column);
        }
    }

    /// <summary>A patch file, or a patch of the library by its name.</summary>
    public sealed class Patch : IDisposable
    {
        internal IntPtr Pointer;

        public Patch(string nameOrPath)
        {
            var error = new Native.Error();
            Pointer = Native.tactus_load(Native.Utf8(nameOrPath), error);
            Native.Check(Pointer == IntPtr.Zero, error);
        }

        /// <summary>Sets what runs begin with: Configure("blade.stiffness", "0.5 N/mm").</summary>
        public void Configure(string parameter, string value)
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_configure(Pointer, Native.Utf8(parameter + "=" + value), error) != 0, error);
        }

        public void UseAsset(string name, string file)
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_use_asset(Pointer, Native.Utf8(name + "=" + file), error) != 0, error);
        }

        /// <summary>The device [devices.NAME] is moved by Run.Move.</summary>
        public void AttachHand(string name, Device device)
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_attach_hand(Pointer, Native.Utf8(name), ref device, error) != 0, error);
        }

        /// <summary>A run that Run.Advance advances, or one in real time on threads of its own.</summary>
        public Run Start(bool live = false)
        {
            var error = new Native.Error();
            var options = new Native.Options
            {
                Size = (UIntPtr)Marshal.SizeOf(typeof(Native.Options)),
                Live = live ? 1 : 0,
            };
            IntPtr run = Native.tactus_start(Pointer, ref options, error);
            Native.Check(run == IntPtr.Zero, error);
            return new Run(run);
        }

        public void Dispose()
        {
            if (Pointer != IntPtr.Zero) Native.tactus_free_patch(Pointer);
            Pointer = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Patch()
        {
            Dispose();
        }
    }

    public sealed class Run : IDisposable
    {
        private IntPtr pointer;
        private readonly Dictionary<string, KeyValuePair<int, double[]>> outputs =
            new Dictionary<string, KeyValuePair<int, double[]>>();

        internal Run(IntPtr run)
        {
            pointer = run;
        }

        /// <summary>Runs every activation before the present logical time + seconds.</summary>
        public void Advance(double seconds)
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_advance(pointer, seconds, error) != 0, error);
        }

        /// <summary>Logical time, s.</summary>
        public double Time
        {
            get { return Native.tactus_time(pointer); }
        }

        /// <summary>Sets a parameter of the run: Set("blade.stiffness", "0.8 N/mm").</summary>
        public void Set(string parameter, string value)
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_set(pointer, Native.Utf8(parameter), Native.Utf8(value), error) != 0, error);
        }

        public int FindHand(string name)
        {
            var error = new Native.Error();
            int hand = Native.tactus_find_hand(pointer, Native.Utf8(name), error);
            Native.Check(hand < 0, error);
            return hand;
        }

        /// <summary>In a live run a hand that is not moved for 20 ms counts as lost, and the force fades.</summary>
        public void Move(int hand, Motion motion)
        {
            Native.tactus_move_hand(pointer, hand, ref motion);
        }

        public Wrench Force(int hand)
        {
            Wrench wrench;
            Native.tactus_hand_force(pointer, hand, out wrench);
            return wrench;
        }

        /// <summary>The newest value of an output, "coupling.pose". The array is used again by the next call.</summary>
        public double[] Newest(string port)
        {
            KeyValuePair<int, double[]> output;
            if (!outputs.TryGetValue(port, out output))
            {
                var error = new Native.Error();
                Native.OutputInfo info;
                int number = Native.tactus_output(pointer, Native.Utf8(port), 0, out info, error);
                Native.Check(number < 0, error);
                output = new KeyValuePair<int, double[]>(number, new double[info.Columns]);
                outputs[port] = output;
            }
            Native.tactus_newest(pointer, output.Key, output.Value);
            return output.Value;
        }

        /// <summary>Ends the run; returns the hash over every value of every output.</summary>
        public string Finish()
        {
            var error = new Native.Error();
            Native.Check(Native.tactus_finish(pointer, error) != 0, error);
            return Native.tactus_hash(pointer).ToString("x16");
        }

        public void Dispose()
        {
            if (pointer != IntPtr.Zero) Native.tactus_free_run(pointer);
            pointer = IntPtr.Zero;
            GC.SuppressFinalize(this);
        }

        ~Run()
        {
            Dispose();
        }
    }
}
