// SPDX-License-Identifier: Apache-2.0
// A loop of 1 kHz around a patch, by Mono or .NET without Unity. The device is a formula that presses a ball 3 mm against a larger one
// and slides over it.
using System;
using Tactus;

public static class Program
{
    public static int Main()
    {
        using (var patch = new Patch("touch-sphere"))
        {
            patch.AttachHand("simulated", new Device { MaxForce = 8.0, Damping = 2.0 });
            using (Run run = patch.Start())
            {
                int hand = run.FindHand("simulated");
                double largest = 0.0;
                for (int tick = 0; tick < 3000; ++tick)
                {
                    double t = 0.001 * tick, depth = Math.Min(t, 1.0) * 0.008;
                    run.Move(hand, new Motion
                    {
                        X = 0.002 * Math.Sin(2.0 * t), Z = 0.005 - depth, W = 1.0,
                        VelocityX = 0.004 * Math.Cos(2.0 * t), VelocityZ = t < 1.0 ? -0.008 : 0.0,
                    });
                    run.Advance(0.001);
                    largest = Math.Max(largest, Math.Abs(run.Force(hand).ForceZ));
                }
                Console.WriteLine("largest force: {0:F3} N at {1:F1} s", largest, run.Time);
                Console.WriteLine("coupling.pose: {0} numbers", run.Newest("coupling.pose").Length);
                try
                {
                    run.Set("coupling.stiffnes", "1 N/mm");
                    return 1;
                }
                catch (TactusException error)
                {
                    Console.WriteLine(error.Message);
                }
                Console.WriteLine("hash: " + run.Finish());
                return largest > 0.5 && largest <= 8.0 ? 0 : 1;
            }
        }
    }
}
